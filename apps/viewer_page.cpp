#include "viewer_page.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace firstcontact::app {

std::string viewer_page() {
  const auto tool = std::filesystem::canonical("/proc/self/exe");
  const auto path = tool.parent_path().parent_path() / "share/firstcontact/viewer.html";
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file || text.empty()) {
    throw std::runtime_error(path.string() +
                             ": the viewer's page is missing here; build it with "
                             "-DFIRSTCONTACT_BUILD_VIEWER=ON (needs npm)");
  }
  return text;
}

}  // namespace firstcontact::app
