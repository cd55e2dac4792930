#include <firstcontact/scene_files/detail/scene_text.h>

#include <string_view>

#include <firstcontact/text/file_extension.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/read_file.h>

namespace firstcontact::detail {
namespace {

struct NoScene {
  std::string_view ending;
  const char* kind;
  const char* mend;
};

constexpr const char* kAsShape = R"(a scene has it as the shape of a body: {"mesh": FILE})";
constexpr const char* kAsPoints = R"(a scene has it as the shape of a body: {"points": FILE})";
constexpr const char* kAsMotion = "give it as --trajectory, beside --robot";

constexpr NoScene kNoScenes[] = {
    {"obj", "a mesh", kAsShape},
    {"stl", "a mesh", kAsShape},
    {"ply", "a mesh", kAsShape},
    {"off", "a mesh", kAsShape},
    {"dae", "a mesh", kAsShape},
    {"glb", "a mesh", kAsShape},
    {"gltf", "a mesh", kAsShape},
    {"pcd", "points", kAsPoints},
    {"xyz", "points", kAsPoints},
    {"csv", "a trajectory", kAsMotion},
    {"urdf", "a robot", "give it as --robot, or in \"robots\" of a scene"},
    {"srdf", "an SRDF", "give it as --srdf, beside --robot"},
    {"yaml", "YAML", "give a MoveIt request as --request, a planning scene as --environment"},
};

}  // namespace

std::string scene_text(const std::filesystem::path& path) {
  std::string text = read_file(path, "a scene file");
  for (const NoScene& other : kNoScenes) {
    if (file_extension(path) == other.ending) {
      throw ParseError(
          path, std::string("expected a scene (.json), got ") + other.kind + "; " + other.mend);
    }
  }
  return text;
}

}  // namespace firstcontact::detail
