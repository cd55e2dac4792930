#include <firstcontact/model_files/detail/gltf_mesh.h>

#include <algorithm>
#include <utility>

#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

constexpr GltfExpected kPositions{.type = "VEC3", .floats = true, .integers = true};
constexpr GltfExpected kIndices{.type = "SCALAR", .floats = false, .integers = true};
constexpr GltfExpected kJoints{.type = "VEC4", .floats = false, .integers = true};
constexpr GltfExpected kWeights{.type = "VEC4", .floats = true, .integers = true};

/// Reads one primitive; `place` is the primitive's, for notes.
class PrimitiveReader {
 public:
  PrimitiveReader(const GltfDocument& document, const GltfAccessorReader& accessors,
                  const JsonValue& where, std::string place)
      : document_(document),
        accessors_(accessors),
        where_(where),
        place_(std::move(place)),
        object_(document.checked(where, GltfObject::primitive, place_)),
        attributes_(document.object(document.reader().member(where, "attributes"))) {}

  /// Reads the primitive; nothing where it has no triangles.
  [[nodiscard]] std::optional<GltfPrimitive> read() const {
    const std::optional<GltfMode> mode = read_mode();
    const JsonValue* const positions = find(attributes_, "POSITION");
    check_attributes();
    if (mode && positions == nullptr) {
      document_.log().leave_out("primitive without POSITION", "it has no shape");
    }
    if (!mode || positions == nullptr) {
      return std::nullopt;
    }
    GltfPrimitive primitive{
        .where = &where_, .mode = *mode, .positions = accessors_.read(*positions, kPositions)};
    warn_of_integers(primitive.positions);
    if (const JsonValue* const indices = find(object_, "indices")) {
      primitive.indices = accessors_.read(*indices, kIndices);
    }
    refuse_compressed(primitive);
    check_corner_count(primitive);
    primitive.targets = read_targets(primitive.positions.count());
    primitive.influences = read_influences(primitive.positions.count());
    return primitive;
  }

 private:
  [[nodiscard]] std::optional<GltfMode> read_mode() const {
    const std::uint64_t mode = document_.whole(object_, "mode", 4);
    if (mode == 0) {
      document_.log().leave_out("points", "a drawing, not a surface");
      return std::nullopt;
    }
    if (mode <= 3) {
      document_.log().leave_out("lines", "a drawing, not a surface");
      return std::nullopt;
    }
    if (mode > 6) {
      document_.reader().fail_expected("a mode from 0 (points) to 6 (a fan of triangles)",
                                       *find(object_, "mode"));
    }
    return mode == 4 ? GltfMode::triangles : mode == 5 ? GltfMode::strip : GltfMode::fan;
  }

  void check_attributes() const {
    static const std::vector<std::string_view> read = {"POSITION", "JOINTS_0", "WEIGHTS_0"};
    for (const auto& [name, value] : attributes_) {
      const auto begins = [&, &word = name](const char* with) { return word.starts_with(with); };
      if (name == "POSITION" || begins("JOINTS_") || begins("WEIGHTS_")) {
        continue;
      }
      if (name == "NORMAL" || name == "TANGENT" || begins("TEXCOORD_") || begins("COLOR_")) {
        document_.log().leave_out(name, "looks");
      } else if (begins("_")) {
        document_.log().leave_out("attribute of an application", "data of an application");
      } else if (const auto nearest = nearest_word(name, read); !nearest.empty()) {
        document_.refuse(
            value, place_,
            "unknown attribute " + in_quotes(name) + "; did you mean " + in_quotes(nearest) + "?",
            name);
      } else {
        document_.log().warn(
            ParseError(document_.log().path(), value.line,
                       place_ + ": the attribute " + in_quotes(name) + " is not known"),
            name);
      }
    }
  }

  void warn_of_integers(const GltfAccessor& positions) const {
    if (positions.type() == GltfNumber::float32 || names_quantization()) {
      return;
    }
    document_.log().warn(
        ParseError(document_.log().path(), where_.line,
                   place_ + ": its positions are integers, but extensionsUsed does not name "
                            "KHR_mesh_quantization; they were read as that says"),
        "KHR_mesh_quantization");
  }

  [[nodiscard]] bool names_quantization() const {
    const JsonValue* const used = find(document_.root(), "extensionsUsed");
    if (used == nullptr) {
      return false;
    }
    const JsonArray& names = document_.array(*used);
    return std::any_of(names.begin(), names.end(), [](const JsonValue& value) {
      const auto* const name = std::get_if<std::string>(&value.value);
      return name != nullptr && *name == "KHR_mesh_quantization";
    });
  }

  /// Refuses Draco compression: its accessors may have no bytes of their own and would be read as
  /// zeros.
  void refuse_compressed(const GltfPrimitive& primitive) const {
    if (document_.extension(object_, "KHR_draco_mesh_compression") == nullptr) {
      return;
    }
    if (!primitive.positions.has_bytes() ||
        (primitive.indices && !primitive.indices->has_bytes())) {
      document_.fail(where_,
                     "\"KHR_draco_mesh_compression\" is not read; decompress the file first");
    }
    document_.log().leave_out("KHR_draco_mesh_compression", "the same geometry stands beside it");
  }

  void check_corner_count(const GltfPrimitive& primitive) const {
    const std::size_t corners = primitive.corner_count();
    const bool whole =
        primitive.mode == GltfMode::triangles ? corners % 3 == 0 : corners == 0 || corners >= 3;
    if (!whole) {
      document_.refuse(where_, place_,
                       primitive.mode == GltfMode::triangles
                           ? "expected three corners for each triangle, got " +
                                 std::to_string(corners) + " corners"
                           : "expected at least three corners, got " + std::to_string(corners),
                       "corners");
    }
  }

  [[nodiscard]] std::vector<std::optional<GltfAccessor>> read_targets(std::size_t count) const {
    std::vector<std::optional<GltfAccessor>> targets;
    const JsonValue* const array = find(object_, "targets");
    if (array == nullptr) {
      return targets;
    }
    for (const JsonValue& target : document_.array(*array)) {
      const JsonValue* const positions = find(document_.object(target), "POSITION");
      targets.emplace_back();
      if (positions != nullptr) {
        targets.back() = accessors_.read(*positions, kPositions);
        require_count(*positions, *targets.back(), count);
      }
    }
    return targets;
  }

  [[nodiscard]] std::vector<GltfInfluences> read_influences(std::size_t count) const {
    std::vector<GltfInfluences> influences;
    for (std::size_t set = 0;; ++set) {
      const std::string number = std::to_string(set);
      const JsonValue* const joints = find(attributes_, "JOINTS_" + number);
      const JsonValue* const weights = find(attributes_, "WEIGHTS_" + number);
      if (joints == nullptr && weights == nullptr) {
        return influences;
      }
      if (joints == nullptr || weights == nullptr) {
        document_.fail(where_, "expected JOINTS_" + number + " and WEIGHTS_" + number +
                                   " together, got one of them");
      }
      influences.push_back(
          {accessors_.read(*joints, kJoints), accessors_.read(*weights, kWeights)});
      require_count(*joints, influences.back().joints, count);
      require_count(*weights, influences.back().weights, count);
    }
  }

  void require_count(const JsonValue& where, const GltfAccessor& accessor,
                     std::size_t count) const {
    if (accessor.count() != count) {
      document_.fail(where, "expected as many elements as POSITION has, " + std::to_string(count) +
                                ", got " + std::to_string(accessor.count()));
    }
  }

  const GltfDocument& document_;
  const GltfAccessorReader& accessors_;
  const JsonValue& where_;
  std::string place_;
  const JsonObject& object_;
  const JsonObject& attributes_;
};

}  // namespace

std::size_t GltfPrimitive::triangle_count() const {
  const std::size_t count = corner_count();
  if (mode == GltfMode::triangles) {
    return count / 3;
  }
  return count < 3 ? 0 : count - 2;
}

std::array<std::size_t, 3> GltfPrimitive::corners(std::size_t i) const {
  switch (mode) {
    case GltfMode::triangles:
      break;
    case GltfMode::strip:
      return {i, i + 1 + i % 2, i + 2 - i % 2};
    case GltfMode::fan:
      return {0, i + 1, i + 2};
  }
  return {3 * i, 3 * i + 1, 3 * i + 2};
}

std::vector<double> read_weights(const GltfDocument& document, const JsonObject& object) {
  std::vector<double> weights;
  if (const JsonValue* const array = find(object, "weights")) {
    for (const JsonValue& weight : document.array(*array)) {
      weights.push_back(document.reader().number(weight));
    }
  }
  return weights;
}

GltfMesh read_gltf_mesh(const GltfDocument& document, const GltfAccessorReader& accessors,
                        std::size_t index) {
  const JsonValue& where = document.all(GltfArray::meshes)[index];
  const std::string place = "meshes[" + std::to_string(index) + "]";
  GltfMesh mesh;
  mesh.weights = read_weights(document, document.checked(where, GltfObject::mesh, place));
  const JsonArray& primitives = document.array(document.reader().member(where, "primitives"));
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    auto primitive = PrimitiveReader(document, accessors, primitives[i],
                                     place + ".primitives[" + std::to_string(i) + "]")
                         .read();
    if (primitive) {
      mesh.primitives.push_back(std::move(*primitive));
    }
  }
  return mesh;
}

}  // namespace firstcontact::detail
