#include <firstcontact/record/same_run.h>

#include <algorithm>
#include <string>

#include <nlohmann/json.hpp>

#include <firstcontact/record/write_run.h>

namespace firstcontact {
namespace {

using Json = nlohmann::ordered_json;

/// Empties a path. The same key may hold numbers instead.
void forget_path(Json& object, const char* key) {
  if (const auto found = object.find(key); found != object.end() && found->is_string()) {
    *found = "";
  }
}

void forget_paths_of_shape(Json& shape) {
  forget_path(shape, "mesh");
  forget_path(shape, "points");
  if (const auto hull = shape.find("convex_hull"); hull != shape.end()) {
    forget_path(*hull, "mesh");
  }
  if (const auto map = shape.find("heightmap"); map != shape.end()) {
    forget_path(*map, "heights");
  }
}

void forget_paths_of_robot(Json& robot) {
  forget_path(robot, "urdf");
  forget_path(robot, "srdf");
  robot.erase("package_roots");
}

/// Parses a header line, and empties the paths in its scene. Discarded where it is no header.
Json without_paths(std::string_view line) {
  Json header = Json::parse(line, nullptr, /*allow_exceptions=*/false);
  try {
    Json& scene = header.at("scene");
    for (Json& body : scene.at("bodies")) {
      forget_paths_of_shape(body.at("shape"));
    }
    if (const auto robots = scene.find("robots"); robots != scene.end()) {
      std::ranges::for_each(*robots, forget_paths_of_robot);
    }
    header.erase("resolved_digest");  // It hangs on the paths; the scene is compared itself.
  } catch (const Json::exception&) {
    return Json(Json::value_t::discarded);
  }
  return header;
}

}  // namespace

bool is_header_line_of(std::string_view line, const RunHeader& header) {
  std::string own = write_run_header(header);
  own.pop_back();  // The line feed.
  if (line == own) {
    return true;
  }
  const Json given = without_paths(line);
  return !given.is_discarded() && given == without_paths(own);
}

}  // namespace firstcontact
