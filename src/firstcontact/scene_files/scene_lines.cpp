#include <firstcontact/scene_files/scene_lines.h>

#include <utility>

#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/sha256.h>

namespace firstcontact {
namespace {

bool is_blank(const std::string& line) {
  return line.find_first_not_of(" \t\r") == std::string::npos;
}

}  // namespace

SceneLines::SceneLines(std::filesystem::path file)
    : file_(std::move(file)), stream_(file_, std::ios::binary) {}

std::optional<SceneLine> SceneLines::next() {
  SceneLine line;
  while (std::getline(stream_, line.text)) {
    line.number = ++number_;
    digest_ = detail::sha256(digest_ + line.text);
    if (!is_blank(line.text)) {
      return line;
    }
  }
  if (!stream_.eof()) {
    throw ParseError(file_.string(), "expected a file of scenes, cannot read this one");
  }
  return std::nullopt;
}

}  // namespace firstcontact
