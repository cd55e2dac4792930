#include <firstcontact/model_files/detail/dae_geometry.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include <firstcontact/model_files/detail/dae_source.h>

namespace firstcontact::detail {
namespace {

void refuse_hull_of_another(const DaeDocument& document, const XmlElement& mesh) {
  if (mesh.Attribute("convex_hull_of") != nullptr) {
    document.fail(mesh,
                  "a 'convex_hull_of' another geometry is not read; write the triangles of the "
                  "hull");
  }
}

/// Finds the <mesh> or <convex_mesh> of a geometry.
const XmlElement& mesh_of(const DaeDocument& document, const XmlElement& geometry) {
  const XmlElement* mesh = nullptr;
  for (const XmlElement* child = geometry.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    const std::string_view name = child->Name();
    if (name == "spline" || name == "brep") {
      document.fail(*child, "curves and surfaces are not read; write triangles");
    }
    if (name != "mesh" && name != "convex_mesh") {
      continue;
    }
    if (mesh != nullptr) {
      document.fail(*child, "a second mesh in a geometry; keep one");
    }
    mesh = child;
  }
  if (mesh == nullptr) {
    document.fail(geometry, "expected a <mesh> inside");
  }
  refuse_hull_of_another(document, *mesh);
  return *mesh;
}

const XmlElement& position_source(const DaeDocument& document, const XmlElement& mesh) {
  const XmlElement& vertices = document.xml().required_child(mesh, "vertices");
  document.check_children(vertices, {"input"});
  const XmlElement* found = nullptr;
  for (const XmlElement* input : document.xml().children(vertices, "input")) {
    const char* const semantic = input->Attribute("semantic");
    if (semantic == nullptr || std::string_view(semantic) != "POSITION") {
      continue;
    }
    if (found != nullptr) {
      document.fail(*input, "a second POSITION of <vertices>; keep one");
    }
    found = input;
  }
  if (found == nullptr) {
    document.fail(vertices, "expected an <input semantic=\"POSITION\"> inside");
  }
  return document.find_in(mesh, *found, "source", "source");
}

}  // namespace

const std::vector<Eigen::Vector3d>& DaeGeometries::positions(const XmlElement& geometry) {
  const auto known = positions_.find(&geometry);
  if (known != positions_.end()) {
    return known->second;
  }
  const XmlElement& mesh = mesh_of(document_, geometry);
  return positions_.emplace(&geometry, read_dae_points(document_, position_source(document_, mesh)))
      .first->second;
}

const std::vector<DaePolygons>& DaeGeometries::polygons(const XmlElement& geometry) {
  const auto known = polygons_.find(&geometry);
  if (known != polygons_.end()) {
    return known->second;
  }
  document_.check_children(geometry, {"mesh", "convex_mesh"});
  const XmlElement& mesh = mesh_of(document_, geometry);
  std::vector<DaePolygons> all = read_dae_polygons(document_, mesh);
  if (all.empty() && std::string_view(mesh.Name()) == "convex_mesh") {
    document_.fail(mesh, "expected polygons; the hull of vertices alone is not read");
  }
  if (!all.empty()) {
    const std::size_t count = positions(geometry).size();
    for (const DaePolygons& polygons : all) {
      if (!polygons.corners.empty() &&
          *std::max_element(polygons.corners.begin(), polygons.corners.end()) >= count) {
        document_.fail(*polygons.element, "expected indices of vertices below " +
                                              std::to_string(count) + ", got a greater one");
      }
    }
  }
  return polygons_.emplace(&geometry, std::move(all)).first->second;
}

}  // namespace firstcontact::detail
