#include "contact_text.h"

#include <cmath>

#include <fmt/core.h>

#include <firstcontact/scene/write_result.h>

#include "quantity_text.h"

namespace firstcontact::app {

std::string feature_text(const Feature& feature) {
  return feature.type == FeatureType::face ? fmt::format("triangle {}", feature.index)
                                           : fmt::format("{} {} of triangle {}", word(feature.type),
                                                         feature.index, feature.triangle);
}

std::string contact_text(const Contact& contact, double duration) {
  std::string text = fmt::format("at ({:.6g}, {:.6g}, {:.6g}) m, distance {}", contact.p_WA.x(),
                                 contact.p_WA.y(), contact.p_WA.z(), length_text(contact.distance));
  if (!contact.n_AB_W) {
    return text;
  }
  return text + fmt::format(", normal {}, {} {}", direction_text(*contact.n_AB_W),
                            contact.normal_velocity < 0.0 ? "closing at" : "leaving at",
                            speed_text(std::abs(contact.normal_velocity) / duration));
}

}  // namespace firstcontact::app
