#include <firstcontact/page/write_page.h>

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>
#include <vector>

#include <firstcontact/page/detail/page_meshes.h>
#include <firstcontact/page/detail/page_robots.h>
#include <firstcontact/scene_files/detail/reports_json.h>
#include <firstcontact/scene_files/detail/result_json.h>
#include <firstcontact/text/json_tree.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

using detail::JsonArray;
using detail::JsonObject;
using detail::JsonValue;
using detail::to_json;

constexpr std::string_view kPlaceholder = "\"FIRSTCONTACT_RESULT\"";

/// Of each body the number of its mesh.
JsonArray meshes_of_bodies(const LoadedScene& loaded, detail::PageMeshes& meshes) {
  JsonArray bodies;
  for (std::size_t body = 0; body < loaded.scene.bodies.size(); ++body) {
    const Shape& shape =
        loaded.robots ? loaded.robots->geometries(body)[0].shape : loaded.bodies.shape(body);
    bodies.push_back(to_json(meshes.add(shape.mesh())));
  }
  return bodies;
}

/// Samples or corners of a bound: both have a time and a distance.
template <typename Point>
JsonValue line_to_json(std::span<const Point> points) {
  JsonArray times;
  JsonArray distances;
  for (const Point& point : points) {
    if (std::isfinite(point.distance)) {
      times.push_back(to_json(point.t));
      distances.push_back(to_json(point.distance));
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

/// What bodies and robots look like.
JsonObject look_of(const LoadedScene& loaded) {
  detail::PageMeshes meshes;
  JsonObject view{{"bodies", {.value = meshes_of_bodies(loaded, meshes)}}};
  if (loaded.robots) {
    std::vector<std::string> warnings;
    view.push_back({"robots", {.value = detail::robots_of_page(*loaded.robots, meshes, warnings)}});
    view.push_back({"carried", {.value = detail::carried_of_page(*loaded.robots)}});
    view.push_back({"warnings", to_json(warnings)});
  }
  view.push_back({"meshes", {.value = meshes.take()}});
  return view;
}

std::string fill(std::string_view page_template, const PageRecord& record, JsonObject view) {
  const std::size_t place = page_template.find(kPlaceholder);
  if (place == std::string_view::npos) {
    throw std::invalid_argument("the viewer's page has no place for a result");
  }
  std::string page(page_template.substr(0, place));
  page += "{" + detail::write_json(record.name) + ":" + without_tags(record.json) +
          ",\"view\":" + detail::write_json({.value = std::move(view)}) + "}";
  page += page_template.substr(place + kPlaceholder.size());
  return page;
}

}  // namespace

std::string write_page(std::string_view page_template, const LoadedScene& loaded,
                       std::string_view result, const GapChart& gap) {
  JsonObject view = look_of(loaded);
  view.push_back({"gap", line_to_json(gap.samples)});
  view.push_back({"gap_bound", line_to_json(gap.lower_bound)});
  return fill(page_template, {.name = "result", .json = result}, std::move(view));
}

std::string write_page(std::string_view page_template, const LoadedScene& loaded,
                       const PageRecord& record) {
  JsonObject view = look_of(loaded);
  if (!loaded.robots) {
    view.push_back({"warnings", to_json(loaded.warnings)});
  }
  view.push_back({"pair_counts", detail::pair_counts_json(loaded.pair_counts)});
  view.push_back({"files", detail::reports_json(loaded.files)});
  return fill(page_template, record, std::move(view));
}

}  // namespace firstcontact
