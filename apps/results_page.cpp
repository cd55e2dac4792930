#include "results_page.h"

#include <cstddef>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include <firstcontact/page/write_page.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene_files/read_result.h>

#include "atomic_file.h"
#include "terminal_text.h"
#include "viewer_page.h"

namespace firstcontact::app {
namespace {

constexpr std::size_t kMostBytes = 200'000'000;  // Browsers open texts of twice this size.

/// Adds a result; returns whether the page can play it.
bool add(const std::string& line, const std::string& results, std::size_t number,
         const ReadingOptions& reading, ShapeCache& cache, ListPage& list) {
  if (read_summary(line, results, number).verdict && list.size() < kMostBytes) {
    try {
      list.add(line, load_scene(read_result(line, results, reading).scene, cache));
      return true;
    } catch (const std::exception&) {  // Its files are gone, or have changed.
    }
  }
  list.add(line);
  return false;
}

}  // namespace

std::string write_results_page(const std::string& results, const std::string& page,
                               const ReadingOptions& reading, const std::stop_token& stop,
                               const std::function<void(std::string)>& doing) {
  const std::string viewer = viewer_page();
  std::ifstream file(results, std::ios::binary);
  if (!file) {
    throw std::runtime_error(results + ": cannot be read");
  }
  ShapeCache cache;
  ListPage list;
  std::size_t count = 0;
  std::size_t playable = 0;
  for (std::string line; std::getline(file, line) && !stop.stop_requested();) {
    ++count;
    doing(fmt::format("page: result {}", count));
    playable += add(line, results, count, reading, cache, list) ? 1 : 0;
  }
  if (stop.stop_requested()) {
    return "interrupted before the page was made\n";
  }
  write_file(page, list.write(viewer));
  return fmt::format("page of {} results, {} to be played: {}\n", count, playable, visible(page));
}

}  // namespace firstcontact::app
