#include <firstcontact/model_files/detail/parse_gltf.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/model_files/detail/glb_chunks.h>
#include <firstcontact/model_files/detail/gltf_accessor.h>
#include <firstcontact/model_files/detail/gltf_buffers.h>
#include <firstcontact/model_files/detail/gltf_document.h>
#include <firstcontact/model_files/detail/gltf_instances.h>
#include <firstcontact/model_files/detail/gltf_left_out.h>
#include <firstcontact/model_files/detail/gltf_mesh.h>
#include <firstcontact/model_files/detail/gltf_nodes.h>
#include <firstcontact/model_files/detail/gltf_skin.h>
#include <firstcontact/model_files/detail/gltf_surface.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/parse_json.h>

namespace firstcontact::detail {
namespace {

/// A mesh at a node.
struct PlacedMesh {
  std::size_t node = 0;
  std::size_t mesh = 0;
  std::optional<std::size_t> skin;
  std::vector<double> weights;  ///< Weights of its morph targets.
  std::optional<GltfInstances> instances;
};

/// The size of all that a document places.
struct PlacedSize {
  double vertices = 0.0;
  double triangles = 0.0;
  double work = 0.0;  ///< As GltfLimits counts it.
};

/// Reads the scene of a document: first the content of its nodes, then the triangles.
class SceneReader {
 public:
  SceneReader(const GltfDocument& document, GltfBuffers& buffers, std::size_t file_size)
      : document_(document),
        buffers_(buffers),
        file_size_(file_size),
        accessors_(document, buffers, file_size),
        nodes_(place_nodes(document)),
        meshes_(document.all(GltfArray::meshes).size()),
        skins_(document.all(GltfArray::skins).size()) {}

  [[nodiscard]] Mesh read(const GltfLimits& limits) {
    if (document_.all(GltfArray::scenes).empty() && !nodes_.scene.empty()) {
      document_.log().warn(
          ParseError(document_.log().path(), "the file has no scene: all of its nodes are read"));
    }
    for (const std::size_t node : nodes_.scene) {
      read_node(node);
    }
    note();
    document_.log().throw_errors();
    const PlacedSize size = measure(limits);
    GltfSurface surface(document_);
    surface.reserve(static_cast<std::size_t>(size.vertices),
                    static_cast<std::size_t>(size.triangles));
    for (const PlacedMesh& placed : placed_) {
      add(placed, surface);
    }
    return surface.finish();
  }

 private:
  void read_node(std::size_t node) {
    const JsonValue& where = document_.all(GltfArray::nodes)[node];
    const JsonObject& object = document_.object(where);
    refuse_hidden(object, where, node);
    const JsonValue* const instancing = document_.extension(object, "EXT_mesh_gpu_instancing");
    const JsonValue* const mesh = find(object, "mesh");
    const JsonValue* const skin = find(object, "skin");
    if (mesh == nullptr) {
      return;
    }
    PlacedMesh placed;
    placed.node = node;
    placed.mesh = document_.index(*mesh, GltfArray::meshes);
    placed.weights = weights_of(object, where, placed.mesh);
    if (skin != nullptr) {
      placed.skin = document_.index(*skin, GltfArray::skins);
      require_influences(placed.mesh);
      if (!skins_[*placed.skin]) {
        skins_[*placed.skin] = read_gltf_skin(document_, accessors_, nodes_, *placed.skin);
      }
    } else {
      note_unused_influences(placed.mesh);
    }
    if (instancing != nullptr && skin != nullptr) {
      document_.fail(*instancing,
                     "expected instances of a mesh without a skin, got one with a skin");
    }
    if (instancing != nullptr) {
      placed.instances.emplace(document_, accessors_, *instancing);
    }
    placed_.push_back(std::move(placed));
  }

  void refuse_hidden(const JsonObject& node, const JsonValue& where, std::size_t index) const {
    const JsonValue* const visibility = document_.extension(node, "KHR_node_visibility");
    const JsonValue* const visible =
        visibility == nullptr ? nullptr : find(document_.object(*visibility), "visible");
    if (visible != nullptr && !document_.reader().boolean(*visible)) {
      document_.refuse(
          where, place_of_node(index),
          "\"KHR_node_visibility\" hides the node, which does not say whether it can be "
          "touched; remove the node or the extension",
          "KHR_node_visibility");
    }
  }

  const GltfMesh& mesh(std::size_t index) {
    if (!meshes_[index]) {
      meshes_[index] = read_gltf_mesh(document_, accessors_, index);
    }
    return *meshes_[index];
  }

  /// Finds the node's weights, else those of its mesh, or none.
  [[nodiscard]] std::vector<double> weights_of(const JsonObject& node, const JsonValue& where,
                                               std::size_t mesh_index) {
    std::vector<double> weights = read_weights(document_, node);
    if (find(node, "weights") == nullptr) {
      weights = mesh(mesh_index).weights;
    }
    for (const GltfPrimitive& primitive : mesh(mesh_index).primitives) {
      if (!weights.empty() && weights.size() != primitive.targets.size()) {
        document_.fail(where,
                       "expected a weight for each of " + std::to_string(primitive.targets.size()) +
                           " morph targets of its mesh, got " + std::to_string(weights.size()));
      }
    }
    return weights;
  }

  void require_influences(std::size_t mesh_index) {
    for (const GltfPrimitive& primitive : mesh(mesh_index).primitives) {
      if (primitive.influences.empty()) {
        document_.fail(*primitive.where,
                       "expected JOINTS_0 and WEIGHTS_0 in a mesh with a skin, got none");
      }
    }
  }

  void note_unused_influences(std::size_t mesh_index) {
    for (const GltfPrimitive& primitive : mesh(mesh_index).primitives) {
      if (!primitive.influences.empty()) {
        document_.log().leave_out("JOINTS_0", "the node has no skin");
      }
    }
  }

  [[nodiscard]] PlacedSize measure(const GltfLimits& limits) const {
    PlacedSize size;
    for (const PlacedMesh& placed : placed_) {
      const double copies = placed.instances ? static_cast<double>(placed.instances->count()) : 1.0;
      for (const GltfPrimitive& primitive : meshes_[placed.mesh]->primitives) {
        const auto vertices =
            static_cast<double>(std::min(primitive.positions.count(), primitive.corner_count()));
        const auto triangles = static_cast<double>(primitive.triangle_count());
        const auto passes =
            static_cast<double>(1 + placed.weights.size() + primitive.influences.size());
        size.vertices += copies * vertices;
        size.triangles += copies * triangles;
        size.work += copies * (vertices * passes + triangles);
      }
    }
    const double most = std::max(static_cast<double>(limits.most_placed),
                                 2.0 * static_cast<double>(file_size_ + buffers_.size_read()));
    if (!(size.work <= most)) {
      throw ParseError(
          document_.log().path(),
          "expected at most " + std::to_string(static_cast<std::size_t>(most)) +
              " vertices and triangles once all nodes have placed their meshes, got more");
    }
    if (!(size.triangles > 0.0)) {
      throw ParseError(document_.log().path(),
                       "expected at least one triangle in the scene, found none");
    }
    return size;
  }

  void add(const PlacedMesh& placed, GltfSurface& surface) const {
    GltfPlacement placement{.weights = placed.weights};
    if (placed.skin) {
      placement.skin = &*skins_[*placed.skin];
    }
    const std::vector<GltfPrimitive>& primitives = meshes_[placed.mesh]->primitives;
    const bool is_empty =
        std::all_of(primitives.begin(), primitives.end(),
                    [](const GltfPrimitive& primitive) { return primitive.triangle_count() == 0; });
    const std::size_t copies = placed.instances ? placed.instances->count() : 1;
    for (std::size_t i = 0; !is_empty && i < copies; ++i) {
      placement.X_WM = nodes_.X_WN[placed.node];
      if (placed.instances) {
        placement.X_WM = placement.X_WM * placed.instances->transform(i);
      }
      for (const GltfPrimitive& primitive : primitives) {
        surface.add(primitive, placement);
      }
    }
  }

  void note() const {
    std::vector<bool> used(meshes_.size(), false);
    std::size_t instances = 0;
    std::size_t skins = 0;
    std::size_t morphs = 0;
    for (const PlacedMesh& placed : placed_) {
      used[placed.mesh] = true;
      instances += placed.instances ? placed.instances->count() : 0;
      skins += placed.skin ? 1 : 0;
      morphs += static_cast<std::size_t>(std::count_if(placed.weights.begin(), placed.weights.end(),
                                                       [](double w) { return w != 0.0; }));
    }
    ReadingLog& log = document_.log();
    log.set_unit("1 m");
    log.add_content("nodes with a mesh", placed_.size());
    for (const auto& [what, count] : {std::pair("instances", instances),
                                      {"nodes with a skin", skins},
                                      {"morph targets", morphs}}) {
      if (count > 0) {
        log.add_content(what, count);
      }
    }
    note_left_out(document_, used);
  }

  const GltfDocument& document_;
  GltfBuffers& buffers_;
  std::size_t file_size_;
  GltfAccessorReader accessors_;
  GltfNodes nodes_;
  std::vector<std::optional<GltfMesh>> meshes_;
  std::vector<std::optional<GltfSkin>> skins_;
  std::vector<PlacedMesh> placed_;
};

}  // namespace

Mesh parse_gltf(std::string_view bytes, const std::filesystem::path& source, ReadingLog& log,
                const GltfLimits& limits) {
  const GlbChunks chunks = split_glb(bytes, log);
  const JsonValue root = parse_json(chunks.json, log.path());
  const GltfDocument document(root, log);
  log.throw_errors();
  GltfBuffers buffers(document, source, chunks.binary);
  return SceneReader(document, buffers, bytes.size()).read(limits);
}

}  // namespace firstcontact::detail
