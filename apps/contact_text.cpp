#include "contact_text.h"

#include <cmath>

#include <fmt/core.h>

#include <firstcontact/scene_files/write_result.h>

#include "quantity_text.h"

namespace firstcontact::app {

std::string feature_text(const Feature& feature) {
  return feature.type == FeatureType::face ? fmt::format("triangle {}", feature.index)
                                           : fmt::format("{} {} of triangle {}", word(feature.type),
                                                         feature.index, feature.triangle);
}

std::string point_text(const Eigen::Vector3d& point) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", point.x(), point.y(), point.z());
}

std::string contact_text(const Contact& contact, double duration) {
  std::string text =
      fmt::format("at {} m, distance {}", point_text(contact.p_WA), length_text(contact.distance));
  if (!contact.n_AB_W) {
    return text;
  }
  return text + fmt::format(", normal {}, {} {}", direction_text(*contact.n_AB_W),
                            contact.normal_velocity < 0.0 ? "closing at" : "leaving at",
                            speed_text(std::abs(contact.normal_velocity) / duration));
}

std::string contact_count_text(const ContactCount& count, std::size_t listed) {
  const bool more = count.at_least > listed;
  const std::string total =
      more ? fmt::format("{} of {}{}", listed, count.is_exact ? "" : "more than ", count.at_least)
           : std::to_string(listed);
  return fmt::format("{} feature pair{}", total, !more && listed == 1 ? "" : "s");
}

}  // namespace firstcontact::app
