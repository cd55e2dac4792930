#include <firstcontact/scene_files/detail/contact_json.h>

#include <cmath>
#include <tuple>
#include <utility>

#include <firstcontact/scene_files/detail/result_json.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

std::string number(double value) { return std::isfinite(value) ? write_json(value) : "null"; }

std::string number(std::size_t value) { return std::to_string(value); }

std::string array(const std::string& first, const std::string& second) {
  return '[' + first + ',' + second + ']';
}

std::string vector(const Eigen::Vector3d& v) {
  return '[' + number(v.x()) + ',' + number(v.y()) + ',' + number(v.z()) + ']';
}

std::string feature(const Feature& feature) {
  return std::string(R"({"type":")") + word(feature.type) + R"(","index":)" +
         number(std::size_t{feature.index}) + '}';
}

}  // namespace

void ContactArray::set_names(const JsonValue& names) { names_ = write_json(names); }

void ContactArray::add(const Contact& contact) {
  const auto& [A, B] = std::tie(contact.feature_A, contact.feature_B);
  text_ += text_.empty() ? '[' : ',';
  text_ += R"({"bodies":)" + names_;
  text_ += R"(,"features":)" + array(feature(A), feature(B));
  text_ +=
      R"(,"triangles":)" + array(number(std::size_t{A.triangle}), number(std::size_t{B.triangle}));
  text_ += R"(,"points":)" + array(vector(contact.p_WA), vector(contact.p_WB));
  text_ += R"(,"normal":)" + (contact.n_AB_W ? vector(*contact.n_AB_W) : "null");
  text_ += R"(,"distance":)" + number(contact.distance);
  text_ += R"(,"normal_velocity":)" + number(contact.normal_velocity / duration_);
  if (geometries_) {
    text_ +=
        R"(,"geometries":)" + array(number(contact.geometries[0]), number(contact.geometries[1]));
  }
  text_ += '}';
}

JsonValue ContactArray::take() {
  text_ += text_.empty() ? "[]" : "]";
  return {.value = JsonText{std::move(text_)}};
}

void append_contact_count(const ContactCount& count, JsonObject& object) {
  object.push_back({"contact_count", to_json(std::size_t{count.at_least})});
  if (count.at_least > 0 && !count.is_exact) {
    object.push_back({"contact_count_is_least", {.value = true}});
  }
}

}  // namespace firstcontact::detail
