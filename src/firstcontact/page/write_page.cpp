#include <firstcontact/page/write_page.h>

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

#include <firstcontact/page/detail/page_meshes.h>
#include <firstcontact/page/detail/page_robots.h>
#include <firstcontact/page/detail/path_look_json.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene_files/detail/reports_json.h>
#include <firstcontact/scene_files/detail/result_json.h>
#include <firstcontact/text/json_tree.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/sha256.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

using detail::JsonArray;
using detail::JsonObject;
using detail::JsonValue;
using detail::to_json;

constexpr std::string_view kPlaceholder = "\"FIRSTCONTACT_RESULT\"";

/// The number of the mesh of each body.
JsonArray meshes_of_bodies(const LoadedScene& loaded, detail::PageMeshes& meshes) {
  JsonArray bodies;
  for (std::size_t body = 0; body < loaded.scene.bodies.size(); ++body) {
    bodies.push_back(to_json(meshes.add(shape_of_body(loaded, body))));
  }
  return bodies;
}

/// Writes samples or corners of a bound: both have a time and a distance.
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

JsonValue rates_to_json(std::span<const RateLook> rates) {
  JsonArray all;
  for (const RateLook& rate : rates) {
    JsonObject object{{"robot", to_json(rate.robot)},
                      {"coordinate", to_json(rate.coordinate)},
                      {"velocity", to_json(rate.velocity)},
                      {"acceleration", to_json(rate.acceleration)}};
    if (rate.jerk) {
      object.push_back({"jerk", to_json(*rate.jerk)});
    }
    all.push_back({.value = std::move(object)});
  }
  return {.value = std::move(all)};
}

/// Escapes `<`, so that no text of the data ends the script that holds it.
///
/// In JSON this letter stands in strings only.
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

/// The looks of bodies and robots.
JsonObject look_of(const LoadedScene& loaded) {
  detail::PageMeshes meshes;
  JsonObject view{{"bodies", {.value = meshes_of_bodies(loaded, meshes)}}};
  if (loaded.robots) {
    std::vector<std::string> warnings;
    std::vector<detail::UrdfColors> colors;
    for (const SceneRobot& robot : loaded.scene.robots) {
      colors.push_back(detail::read_urdf_colors(robot.file.urdf));
    }
    colors.resize(loaded.robots->robot_count());  // A scene may have robots that come from no file.
    view.push_back(
        {"robots", {.value = detail::robots_of_page(*loaded.robots, colors, meshes, warnings)}});
    view.push_back({"carried", {.value = detail::carried_of_page(*loaded.robots)}});
    view.push_back({"warnings", to_json(warnings)});
  }
  view.push_back({"meshes", {.value = meshes.take()}});
  return view;
}

std::string fill(std::string_view page_template, std::string_view data) {
  const std::size_t place = page_template.find(kPlaceholder);
  if (place == std::string_view::npos) {
    throw std::invalid_argument("the viewer's page has no place for a result");
  }
  std::string page(page_template.substr(0, place));
  page += data;
  page += page_template.substr(place + kPlaceholder.size());
  return page;
}

/// The data of the page: a record, and the looks of its bodies.
std::string data_of(const PageRecord& record, JsonObject view) {
  return "{" + detail::write_json(record.name) + ":" + without_tags(record.json) +
         ",\"view\":" + without_tags(detail::write_json({.value = std::move(view)})) + "}";
}

/// The entry of a list for a result or an error.
JsonObject summary_of(std::string_view result) {
  const JsonValue root = detail::parse_json(result, "result");
  const auto* object = std::get_if<JsonObject>(&root.value);
  if (object == nullptr) {
    throw ParseError("result", "expected an object");
  }
  JsonObject summary;
  for (const std::string_view key : {"id", "line", "error", "verdict", "reason", "pair", "t",
                                     "time", "clearance", "pair_counts", "warnings"}) {
    if (const JsonValue* value = find(*object, key)) {
      summary.push_back({std::string(key), *value});
    }
  }
  return summary;
}

}  // namespace

std::string write_page(std::string_view page_template, const LoadedScene& loaded,
                       std::string_view result, const GapChart& gap, const MotionLook& look) {
  JsonObject view = look_of(loaded);
  view.push_back({"gap", line_to_json(gap.samples)});
  view.push_back({"gap_bound", line_to_json(gap.lower_bound)});
  if (look.path != nullptr) {
    view.push_back({"path", detail::path_look_json(*look.path)});
  }
  if (!look.rates.empty()) {
    view.push_back({"rates", rates_to_json(look.rates)});
  }
  return fill(page_template, data_of({.name = "result", .json = result}, std::move(view)));
}

std::string write_page(std::string_view page_template, const LoadedScene& loaded,
                       const PageRecord& record) {
  JsonObject view = look_of(loaded);
  if (!loaded.robots) {
    view.push_back({"warnings", to_json(loaded.warnings)});
  }
  view.push_back({"pair_counts", detail::pair_counts_json(loaded.pair_counts)});
  view.push_back({"files", detail::reports_json(loaded.files)});
  return fill(page_template, data_of(record, std::move(view)));
}

void ListPage::add(std::string_view result) {
  const std::string summary = detail::write_json({.value = summary_of(result)});
  entries_ += entries_.empty() ? "" : ",";
  entries_ += "{\"summary\":" + without_tags(summary) + "}";
  size_ += summary.size();
}

void ListPage::add(std::string_view result, const LoadedScene& loaded) {
  JsonObject view = look_of(loaded);
  for (auto& [key, value] : view) {
    if (key == "meshes") {
      JsonArray numbers;
      for (JsonValue& mesh : std::get<JsonArray>(value.value)) {
        numbers.push_back(to_json(add_mesh(detail::write_json(mesh))));
      }
      value.value = std::move(numbers);
    }
  }
  entries_ += entries_.empty() ? "" : ",";
  const std::size_t before = entries_.size();
  entries_ += data_of({.name = "result", .json = result}, std::move(view));
  size_ += entries_.size() - before;
}

std::size_t ListPage::add_mesh(std::string json) {
  const auto [place, is_new] = of_digests_.try_emplace(detail::sha256(json), meshes_.size());
  if (is_new) {
    size_ += json.size();
    meshes_.push_back(std::move(json));
  }
  return place->second;
}

std::string ListPage::write(std::string_view page_template) const {
  std::string data = "{\"list\":[" + entries_ + "],\"meshes\":[";
  for (std::size_t k = 0; k < meshes_.size(); ++k) {
    data += (k > 0 ? "," : "") + meshes_[k];
  }
  return fill(page_template, data + "]}");
}

}  // namespace firstcontact
