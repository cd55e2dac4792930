#include <firstcontact/model_files/detail/dae_skin.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <Eigen/Geometry>

#include <firstcontact/model_files/detail/dae_source.h>
#include <firstcontact/model_files/detail/dae_transform.h>
#include <firstcontact/text/text_cursor.h>

namespace firstcontact::detail {
namespace {

using Eigen::Affine3d;
using Eigen::Vector3d;

/// An <input> with the source that it names.
struct Input {
  const XmlElement* element = nullptr;
  const XmlElement* source = nullptr;
};

/// Finds the one input of this semantic inside of an element of the skin.
Input required_input(const DaeDocument& document, const XmlElement& skin, const XmlElement& parent,
                     std::string_view semantic) {
  Input found;
  for (const XmlElement* input : document.xml().children(parent, "input")) {
    const char* const its = input->Attribute("semantic");
    if (its == nullptr || semantic != its) {
      continue;
    }
    if (found.element != nullptr) {
      document.fail(*input, "a second input " + std::string(semantic) + "; keep one");
    }
    found = {input, &document.find_in(skin, *input, "source", "source")};
  }
  if (found.element == nullptr) {
    document.fail(parent, "expected an input " + std::string(semantic) + " of a skin inside");
  }
  return found;
}

/// The joints of a skin, with their maps of bound vertices.
class SkinJoints {
 public:
  SkinJoints(const DaeDocument& document, DaeJointFinder& finder, const XmlElement& instance,
             const XmlElement& skin)
      : document_(document),
        finder_(finder),
        instance_(instance),
        skeletons_(finder.skeletons(instance)),
        X_bind_(bind_shape(skin)) {
    const XmlElement& joints = document.xml().required_child(skin, "joints");
    document.check_children(joints, {"input"});
    joints_ = required_input(document, skin, joints, "JOINT");
    const Input bind = required_input(document, skin, joints, "INV_BIND_MATRIX");
    names_ = read_dae_names(document, *joints_.source);
    matrices_ = read_dae_numbers(document, *bind.source, 16);
    matrix_source_ = bind.source;
    if (matrices_.size() != 16 * names_.names.size()) {
      document.fail(skin, "expected an inverse bind matrix for each of " +
                              std::to_string(names_.names.size()) + " joints of the skin, got " +
                              std::to_string(matrices_.size() / 16));
    }
    maps_.resize(names_.names.size());
    X_shape_ = Eigen::Scaling(document.unit()) * X_bind_;
  }

  [[nodiscard]] std::size_t size() const { return names_.names.size(); }
  [[nodiscard]] const XmlElement& source() const { return *joints_.source; }

  /// Finds the map from the geometry's frame to the world's, for a joint or for the bind shape
  /// (-1). Joints that no vertex needs may be missing.
  const Affine3d& map(std::int64_t joint) {
    if (joint < 0) {
      return X_shape_;
    }
    const auto index = static_cast<std::size_t>(joint);
    if (!maps_[index]) {
      const Affine3d X_WJ = finder_.pose(names_.names[index], names_.ids, skeletons_, instance_);
      const Affine3d B = dae_matrix(document_, *matrix_source_, matrices_.data() + 16 * index);
      maps_[index] = X_WJ * B * X_bind_;
    }
    return *maps_[index];
  }

 private:
  [[nodiscard]] Affine3d bind_shape(const XmlElement& skin) const {
    const XmlElement* const matrix = document_.xml().child(skin, "bind_shape_matrix");
    return matrix == nullptr
               ? Affine3d::Identity()
               : dae_matrix(document_, *matrix, read_dae_row(document_, *matrix, 16).data());
  }

  const DaeDocument& document_;
  DaeJointFinder& finder_;
  const XmlElement& instance_;
  std::vector<const XmlElement*> skeletons_;
  Affine3d X_bind_;
  Affine3d X_shape_;
  Input joints_;
  DaeNames names_;
  std::vector<double> matrices_;
  const XmlElement* matrix_source_ = nullptr;
  std::vector<std::optional<Affine3d>> maps_;
};

/// Reads the weights of all vertices, one after another.
class InfluenceReader {
 public:
  InfluenceReader(const DaeDocument& document, DaeBudget& budget, const XmlElement& skin,
                  const SkinJoints& joints)
      : document_(document),
        budget_(budget),
        element_(document.xml().required_child(skin, "vertex_weights")),
        counts_text_(text_of("vcount")),
        influences_text_(text_of("v")),
        counts_(cursor(counts_text_)),
        influences_(cursor(influences_text_)) {
    document.check_children(element_, {"input", "vcount", "v"});
    const Input joint = required_input(document, skin, element_, "JOINT");
    const Input weight = required_input(document, skin, element_, "WEIGHT");
    if (joint.source != &joints.source()) {
      document.fail(*joint.element, "expected the joints that <joints> of the skin names");
    }
    joint_at_ = document.xml().whole_number(*joint.element, "offset");
    weight_at_ = document.xml().whole_number(*weight.element, "offset");
    for (const XmlElement* input : document.xml().children(element_, "input")) {
      last_ = std::max(last_, document.xml().whole_number(*input, "offset"));
    }
    weights_ = read_dae_numbers(document, *weight.source, 1);
    budget_.spend(document, element_, weights_.size());
  }

  void expect_vertices(std::size_t count) const {
    if (document_.xml().whole_number(element_, "count") != count) {
      document_.fail(element_, "expected weights of the skin for each of " + std::to_string(count) +
                                   " vertices");
    }
  }

  /// The sum of the weighted places of a point, and the sum of its weights.
  struct Mean {
    Vector3d sum = Vector3d::Zero();
    double weight = 0.0;
  };

  [[nodiscard]] Mean next(SkinJoints& joints, const Vector3d& point) {
    if (!counts_.find_line()) {
      document_.fail(element_, "expected a number of weights for each vertex, got too few");
    }
    const std::int64_t count = counts_.integer("a number of weights");
    Mean mean;
    for (std::int64_t i = 0; i < count; ++i) {
      const Influence influence = read(joints.size());
      const double weight = weights_[influence.weight];
      if (!std::isfinite(weight)) {
        document_.fail(element_, "expected finite weights of a skin");
      }
      if (weight != 0.0) {
        mean.sum += weight * (joints.map(influence.joint) * point);
        mean.weight += weight;
      }
    }
    return mean;
  }

  void expect_end() {
    if (counts_.find_line() || influences_.find_line()) {
      document_.fail(element_, "expected weights of each vertex and no more");
    }
  }

  [[nodiscard]] const XmlElement& element() const { return element_; }

 private:
  struct Influence {
    std::int64_t joint = 0;
    std::size_t weight = 0;
  };

  [[nodiscard]] XmlText text_of(const char* name) const {
    return document_.xml().content(document_.xml().required_child(element_, name));
  }
  [[nodiscard]] TextCursor cursor(const XmlText& text) const {
    return {text.view(), document_.xml().source(), {}, text.line()};
  }

  [[nodiscard]] Influence read(std::size_t joints) {
    Influence influence;
    budget_.spend(document_, element_, 1);
    for (std::uint64_t at = 0; at <= last_; ++at) {
      if (!influences_.find_line()) {
        document_.fail(element_, "expected a joint and a weight for each influence, got too few");
      }
      const std::int64_t index = influences_.integer("an index");
      if (at == joint_at_) {
        if (index < -1 || index >= static_cast<std::int64_t>(joints)) {
          influences_.fail("expected an index of a joint of the skin, or -1, got " +
                           std::to_string(index));
        }
        influence.joint = index;
      }
      if (at == weight_at_) {
        if (index < 0 || index >= static_cast<std::int64_t>(weights_.size())) {
          influences_.fail("expected an index of a weight, got " + std::to_string(index));
        }
        influence.weight = static_cast<std::size_t>(index);
      }
    }
    return influence;
  }

  const DaeDocument& document_;
  DaeBudget& budget_;
  const XmlElement& element_;
  XmlText counts_text_;
  XmlText influences_text_;
  TextCursor counts_;
  TextCursor influences_;
  std::uint64_t joint_at_ = 0;
  std::uint64_t weight_at_ = 0;
  std::uint64_t last_ = 0;
  std::vector<double> weights_;
};

}  // namespace

std::vector<Vector3d> read_dae_skin(const DaeDocument& document, DaeJointFinder& finder,
                                    DaeBudget& budget, const DaeSkinInstance& instance,
                                    const std::vector<Vector3d>& points) {
  const XmlElement& skin = instance.skin;
  document.check_attributes(skin, {"source"});
  document.check_children(skin, {"bind_shape_matrix", "source", "joints", "vertex_weights"});
  SkinJoints joints(document, finder, instance.element, skin);
  budget.spend(document, skin, 16 * joints.size());
  InfluenceReader influences(document, budget, skin, joints);
  influences.expect_vertices(points.size());
  std::vector<Vector3d> placed;
  placed.reserve(points.size());
  for (const Vector3d& point : points) {
    auto [sum, weight] = influences.next(joints, point);
    if (weight == 0.0) {
      document.refuse(influences.element(), "expected weights of each vertex of the skin, got none",
                      "a vertex without weights");
      sum = joints.map(-1) * point;
      weight = 1.0;
    }
    placed.push_back(weight == 1.0 ? sum : Vector3d(sum / weight));
  }
  influences.expect_end();
  return placed;
}

}  // namespace firstcontact::detail
