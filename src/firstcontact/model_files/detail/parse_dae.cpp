#include <firstcontact/model_files/detail/parse_dae.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/model_files/detail/dae_budget.h>
#include <firstcontact/model_files/detail/dae_document.h>
#include <firstcontact/model_files/detail/dae_geometry.h>
#include <firstcontact/model_files/detail/dae_morph.h>
#include <firstcontact/model_files/detail/dae_polygons.h>
#include <firstcontact/model_files/detail/dae_scene.h>
#include <firstcontact/model_files/detail/dae_skin.h>
#include <firstcontact/polygons/detail/mesh_builder.h>

namespace firstcontact::detail {
namespace {

using Eigen::Affine3d;
using Eigen::Vector3d;

/// Notes the elements beside the scene of a document.
void note_libraries(const DaeDocument& document) {
  constexpr const char* kLooks = "looks";
  constexpr const char* kAnimation = "animation: the nodes have the poses that they state";
  constexpr const char* kSimulator = "shapes and forces of a simulator; the visual scene is read";
  constexpr const char* kJoints = "joints; the poses of the visual scene are read";
  document.check_children(document.root(),
                          {"library_controllers", "library_geometries", "library_nodes",
                           "library_visual_scenes", "scene"},
                          {{"library_animations", kAnimation},
                           {"library_animation_clips", kAnimation},
                           {"library_articulated_systems", kJoints},
                           {"library_cameras", kLooks},
                           {"library_effects", kLooks},
                           {"library_force_fields", kSimulator},
                           {"library_formulas", kJoints},
                           {"library_images", kLooks},
                           {"library_joints", kJoints},
                           {"library_kinematics_models", kJoints},
                           {"library_kinematics_scenes", kJoints},
                           {"library_lights", kLooks},
                           {"library_materials", kLooks},
                           {"library_physics_materials", kSimulator},
                           {"library_physics_models", kSimulator},
                           {"library_physics_scenes", kSimulator}});
}

/// Builds the mesh of a document.
class DaeReader {
 public:
  DaeReader(const DaeDocument& document, std::size_t bytes)
      : document_(document),
        budget_(bytes),
        scene_(document, budget_),
        joints_(document, scene_, budget_),
        geometries_(document) {}

  [[nodiscard]] Mesh read() {
    for (const DaePlacement& placement : scene_.placements()) {
      add(placement);
    }
    note_unused("library_geometries", "geometry");
    note_unused("library_controllers", "controller");
    note_unused("library_visual_scenes", "visual_scene");
    document_.log().add_content("geometries", geometries_.size());
    document_.log().add_content("instances", scene_.placements().size());
    if (mesh_.is_empty()) {
      document_.fail(scene_.element(), "expected at least one polygon in the scene, found none");
    }
    document_.log().throw_errors();
    return mesh_.finish(document_.log());
  }

 private:
  void add(const DaePlacement& placement) {
    const XmlElement& instance = *placement.instance;
    document_.check_attributes(instance, {"url", "sid", "name"});
    if (std::string_view(instance.Name()) == "instance_geometry") {
      const XmlElement& geometry = document_.find(instance, "url", "geometry");
      add_geometry(instance, geometry, placement.X_WN);
    } else {
      add_controller(placement, document_.find(instance, "url", "controller"));
    }
  }

  void add_geometry(const XmlElement& instance, const XmlElement& geometry, const Affine3d& X_WN) {
    const std::vector<DaePolygons>& polygons = take(instance, geometry);
    if (!polygons.empty()) {
      add_polygons(instance, polygons, geometries_.positions(geometry), X_WN);
    }
  }

  /// Takes the polygons of a geometry that is placed once more.
  const std::vector<DaePolygons>& take(const XmlElement& instance, const XmlElement& geometry) {
    used_.insert(&geometry);
    const std::vector<DaePolygons>& all = geometries_.polygons(geometry);
    for (const DaePolygons& polygons : all) {
      budget_.spend(document_, instance, polygons.corners.size());
    }
    if (!all.empty()) {
      budget_.spend(document_, instance, geometries_.positions(geometry).size());
    }
    return all;
  }

  void add_controller(const DaePlacement& placement, const XmlElement& controller) {
    used_.insert(&controller);
    document_.check_children(controller, {"skin", "morph"});
    const XmlElement* const skin = document_.xml().child(controller, "skin");
    const XmlElement* const morph = document_.xml().child(controller, "morph");
    if ((skin == nullptr) == (morph == nullptr)) {
      document_.fail(controller, "expected either a <skin> or a <morph> inside");
    }
    if (skin != nullptr) {
      add_skin(*placement.instance, *skin);
    } else {
      const std::vector<DaePolygons>& polygons =
          take(*placement.instance, dae_morph_base(document_, *morph));
      if (!polygons.empty()) {
        add_polygons(*placement.instance, polygons,
                     read_dae_morph(document_, geometries_, budget_, *morph), placement.X_WN);
      }
    }
  }

  /// Adds a skin of a geometry or of a morph.
  void add_skin(const XmlElement& instance, const XmlElement& skin) {
    const char* const source = skin.Attribute("source");
    const bool of_controller = source != nullptr && *source == '#' &&
                               document_.find_id(source + 1, "geometry") == nullptr &&
                               document_.find_id(source + 1, "controller") != nullptr;
    if (!of_controller) {
      const XmlElement& geometry = document_.find(skin, "source", "geometry");
      skin_polygons(instance, skin, geometry, nullptr);
      return;
    }
    const XmlElement& controller = document_.find(skin, "source", "controller");
    used_.insert(&controller);
    const XmlElement* const morph = document_.xml().child(controller, "morph");
    if (morph == nullptr) {
      document_.fail(skin, "a skin of a skin is not read; expected a geometry or a morph");
    }
    skin_polygons(instance, skin, dae_morph_base(document_, *morph), morph);
  }

  void skin_polygons(const XmlElement& instance, const XmlElement& skin, const XmlElement& geometry,
                     const XmlElement* morph) {
    const std::vector<DaePolygons>& polygons = take(instance, geometry);
    if (polygons.empty()) {
      return;
    }
    const std::vector<Vector3d> points =
        morph == nullptr ? geometries_.positions(geometry)
                         : read_dae_morph(document_, geometries_, budget_, *morph);
    add_polygons(instance, polygons,
                 read_dae_skin(document_, joints_, budget_, {instance, skin}, points),
                 Affine3d::Identity());
  }

  /// Adds polygons, and the vertices that they use.
  void add_polygons(const XmlElement& instance, const std::vector<DaePolygons>& all,
                    const std::vector<Vector3d>& points, const Affine3d& X_WN) {
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> numbers(points.size(), kNone);
    const bool mirrors = X_WN.linear().determinant() < 0.0;
    const auto number = [&](std::uint32_t corner) {
      if (numbers[corner] == kNone) {
        const Vector3d p = X_WN * points[corner];
        numbers[corner] = static_cast<std::uint32_t>(mesh_.vertex_count());
        if (!p.allFinite() || !mesh_.add_vertex(p)) {
          document_.fail(instance, "expected finite coordinates of vertex " +
                                       std::to_string(corner) + " of its geometry");
        }
      }
      return numbers[corner];
    };
    for (const DaePolygons& polygons : all) {
      const auto line = static_cast<std::size_t>(std::max(polygons.element->GetLineNum(), 1));
      std::size_t at = 0;
      const auto add_corners = [&](std::size_t size) {
        for (std::size_t k = 0; k < size; ++k) {
          const std::size_t corner = mirrors ? at + size - 1 - k : at + k;
          if (!mesh_.add_corner(number(polygons.corners[corner]))) {
            document_.fail(instance, "expected less than 2^32 vertices");
          }
        }
        at += size;
      };
      for (std::size_t ring = 0; at < polygons.corners.size();) {
        mesh_.begin_polygon(line);
        add_corners(polygons.rings.empty() ? 3 : polygons.rings[ring].size);
        for (++ring; ring < polygons.rings.size() && polygons.rings[ring].hole; ++ring) {
          mesh_.begin_hole();
          add_corners(polygons.rings[ring].size);
        }
        mesh_.end_polygon();
      }
    }
  }

  /// Counts the elements of a library that are not in the scene.
  void note_unused(const char* library, const char* kind) {
    for (const XmlElement* shelf : document_.xml().children(document_.root(), library)) {
      document_.check_children(*shelf, {kind});
      for (const XmlElement* element : document_.xml().children(*shelf, kind)) {
        if (!used_.contains(element) && element != &scene_.element()) {
          document_.log().leave_out("<" + std::string(kind) + ">", "not in the scene");
        }
      }
    }
  }

  const DaeDocument& document_;
  DaeBudget budget_;
  DaeScene scene_;
  DaeJointFinder joints_;
  DaeGeometries geometries_;
  MeshBuilder mesh_;
  std::unordered_set<const XmlElement*> used_;  ///< Geometries and controllers in the scene.
};

}  // namespace

Mesh parse_dae(std::string_view bytes, ReadingLog& log) {
  try {
    const DaeDocument document(bytes, log);
    note_libraries(document);
    return DaeReader(document, bytes.size()).read();
  } catch (const ParseError& error) {
    if (!log.has_errors()) {
      throw;
    }
    log.add_error(error);  // Unknown names may be the cause.
  }
  log.throw_errors();
  return {};
}

}  // namespace firstcontact::detail
