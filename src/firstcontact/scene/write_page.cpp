#include <firstcontact/scene/write_page.h>

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/scene/detail/base64.h>
#include <firstcontact/scene/detail/json_tree.h>
#include <firstcontact/scene/detail/write_json.h>

namespace firstcontact {
namespace {

using detail::JsonArray;
using detail::JsonObject;
using detail::JsonValue;

constexpr std::string_view kPlaceholder = "\"FIRSTCONTACT_RESULT\"";

/// Numbers of four bytes, in the order that every browser of today has.
class Words {
 public:
  void add(float number) { add(std::bit_cast<std::uint32_t>(number)); }

  void add(std::uint32_t word) {
    for (int shift = 0; shift < 32; shift += 8) {
      bytes_.push_back(static_cast<std::uint8_t>(word >> shift));
    }
  }

  [[nodiscard]] JsonValue json() const { return {.value = detail::base64(bytes_)}; }

 private:
  std::vector<std::uint8_t> bytes_;
};

/// Vertices are relative to the middle, so that single precision suffices far from the origin too.
JsonValue mesh_to_json(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    box.extend(vertex);
  }
  const Eigen::Vector3d middle = box.center();
  Words positions;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    for (const double coordinate : Eigen::Vector3d(vertex - middle)) {
      positions.add(static_cast<float>(coordinate));
    }
  }
  Words triangles;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      triangles.add(corner);
    }
  }
  JsonArray origin;
  for (const double coordinate : middle) {
    origin.push_back({.value = coordinate});
  }
  return {.value = JsonObject{{"origin", {.value = std::move(origin)}},
                              {"positions", positions.json()},
                              {"triangles", triangles.json()}}};
}

detail::JsonMember geometry_of_bodies(const LoadedScene& loaded, JsonArray& meshes) {
  std::map<const Mesh*, std::size_t> known;
  JsonArray bodies;
  for (std::size_t body = 0; body < loaded.bodies.size(); ++body) {
    const Mesh& mesh = loaded.bodies.shape(body).mesh();
    const auto [found, is_new] = known.emplace(&mesh, meshes.size());
    if (is_new) {
      meshes.push_back(mesh_to_json(mesh));
    }
    bodies.push_back({.value = static_cast<double>(found->second)});
  }
  return {"bodies", {.value = std::move(bodies)}};
}

/// Samples or corners of a bound: both have a time and a distance.
template <typename Point>
JsonValue line_to_json(std::span<const Point> points) {
  JsonArray times;
  JsonArray distances;
  for (const Point& point : points) {
    if (std::isfinite(point.distance)) {
      times.push_back({.value = point.t});
      distances.push_back({.value = point.distance});
    }
  }
  return {.value = JsonObject{{"t", {.value = std::move(times)}},
                              {"distance", {.value = std::move(distances)}}}};
}

/// No text of the data may end the script that holds it. In JSON this letter stands in strings
/// only.
std::string without_tags(std::string_view json) {
  std::string text;
  text.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

}  // namespace

std::string write_page(std::string_view page_template, const LoadedScene& loaded,
                       std::string_view result, const GapChart& gap) {
  const std::size_t place = page_template.find(kPlaceholder);
  if (place == std::string_view::npos) {
    throw std::invalid_argument("the viewer's page has no place for a result");
  }
  if (loaded.robots) {
    throw std::invalid_argument("pages are not for scenes with robots yet");
  }
  JsonArray meshes;
  JsonObject view{geometry_of_bodies(loaded, meshes)};
  view.push_back({"meshes", {.value = std::move(meshes)}});
  view.push_back({"gap", line_to_json(gap.samples)});
  view.push_back({"gap_bound", line_to_json(gap.lower_bound)});
  std::string page(page_template.substr(0, place));
  page += "{\"result\":" + without_tags(result) +
          ",\"view\":" + detail::write_json({.value = std::move(view)}) + "}";
  page += page_template.substr(place + kPlaceholder.size());
  return page;
}

}  // namespace firstcontact
