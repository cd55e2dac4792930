#include <firstcontact/model_files/detail/dae_morph.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

#include <firstcontact/model_files/detail/dae_source.h>
#include <firstcontact/text/text_cursor.h>

namespace firstcontact::detail {
namespace {

bool is_relative(const DaeDocument& document, const XmlElement& morph) {
  const char* const value = morph.Attribute("method");
  const std::string_view method = value == nullptr ? "NORMALIZED" : value;
  if (method != "NORMALIZED" && method != "RELATIVE") {
    document.fail(morph,
                  "expected the method NORMALIZED or RELATIVE, got " + detail::quoted(method));
  }
  return method == "RELATIVE";
}

/// Finds the source of an input of <targets>.
const XmlElement& target_source(const DaeDocument& document, const XmlElement& morph,
                                std::string_view semantic) {
  const XmlElement& targets = document.xml().required_child(morph, "targets");
  document.check_children(targets, {"input"});
  for (const XmlElement* input : document.xml().children(targets, "input")) {
    const char* const its = input->Attribute("semantic");
    if (its != nullptr && semantic == its) {
      return document.find_in(morph, *input, "source", "source");
    }
  }
  document.fail(targets, "expected an input " + std::string(semantic) + " inside");
}

}  // namespace

const XmlElement& dae_morph_base(const DaeDocument& document, const XmlElement& morph) {
  document.check_attributes(morph, {"source", "method"});
  document.check_children(morph, {"source", "targets"});
  return document.find(morph, "source", "geometry");
}

std::vector<Eigen::Vector3d> read_dae_morph(const DaeDocument& document, DaeGeometries& geometries,
                                            DaeBudget& budget, const XmlElement& morph) {
  std::vector<Eigen::Vector3d> points = geometries.positions(dae_morph_base(document, morph));
  const DaeNames targets = read_dae_names(document, target_source(document, morph, "MORPH_TARGET"));
  const std::vector<double> weights =
      read_dae_numbers(document, target_source(document, morph, "MORPH_WEIGHT"), 1);
  if (targets.names.size() != weights.size()) {
    document.fail(morph, "expected a weight for each of " + std::to_string(targets.names.size()) +
                             " targets, got " + std::to_string(weights.size()));
  }
  budget.spend(document, morph, weights.size());
  double sum = 0.0;
  for (const double weight : weights) {
    sum += weight;
  }
  if (!std::isfinite(sum)) {
    document.fail(morph, "expected finite weights");
  }
  if (const double rest = 1.0 - sum; rest != 1.0 && !is_relative(document, morph)) {
    for (Eigen::Vector3d& point : points) {
      point *= rest;
    }
  }
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] == 0.0) {
      continue;
    }
    const XmlElement* target = document.find_id(targets.names[i], "geometry");
    if (target == nullptr) {
      document.fail(morph, "expected a geometry with the id " + detail::quoted(targets.names[i]) +
                               " as a target, got none");
    }
    const std::vector<Eigen::Vector3d>& moved = geometries.positions(*target);
    if (moved.size() != points.size()) {
      document.fail(morph, "expected targets of " + std::to_string(points.size()) +
                               " vertices as the base has, got one of " +
                               std::to_string(moved.size()));
    }
    budget.spend(document, morph, points.size());
    for (std::size_t v = 0; v < points.size(); ++v) {
      points[v] += weights[i] * moved[v];
    }
  }
  return points;
}

}  // namespace firstcontact::detail
