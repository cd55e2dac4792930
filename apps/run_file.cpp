#include "run_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include <firstcontact/record/read_run.h>
#include <firstcontact/record/same_run.h>
#include <firstcontact/record/write_run.h>
#include <firstcontact/scene/simulation_duration.h>

namespace firstcontact::app {
namespace {

/// The number of whole lines.
std::size_t count_lines(std::istream& stream) {
  std::string block(std::size_t{1} << 20, '\0');
  std::size_t lines = 0;
  while (stream.read(block.data(), static_cast<std::streamsize>(block.size())) ||
         stream.gcount() > 0) {
    const auto end = block.begin() + stream.gcount();
    lines += static_cast<std::size_t>(std::count(block.begin(), end, '\n'));
  }
  return lines;
}

/// Describes the present contents of a file, and the ways to go on.
///
/// @param resumes  whether the command can go on with the run
std::string describe_held(const std::string& path, const RunHeader& header, bool resumes) {
  constexpr const char* kReplace = "replace it with --force, or give another file";
  std::ifstream stream(path, std::ios::binary);
  std::string first;
  std::getline(stream, first);
  stream.seekg(0);
  const bool is_same = is_header_line_of(first, header);
  try {
    const RunReader run = is_same ? RunReader(stream, path, header) : RunReader(stream, path);
    const std::size_t whole = simulation_step_count(run.header().scene.simulation.value());
    stream.clear();
    stream.seekg(0);
    const std::size_t steps = count_lines(stream) - 1;
    if (steps >= whole) {
      return fmt::format("holds a finished run; {}", kReplace);
    }
    return fmt::format("holds an unfinished run{}, {} of {} steps; {}{}",
                       is_same ? "" : " of another scene or with other options", steps, whole,
                       is_same && resumes ? "go on with --resume, " : "", kReplace);
  } catch (const std::exception&) {
    return fmt::format("holds something already, which is no run; {}", kReplace);
  }
}

}  // namespace

RunFile::RunFile(std::string path, const char* mode)
    : path_(std::move(path)), file_(std::fopen(path_.c_str(), mode)) {
  if (!file_) {
    throw std::runtime_error(path_ + ": cannot write this file: " + std::strerror(errno));
  }
}

RunFile::RunFile(const std::string& path, const RunHeader& header) : RunFile(path, "wb") {
  write(write_run_header(header));
}

RunFile RunFile::begin(const std::string& path, const RunHeader& header, HeldRun on_held) {
  std::error_code error;
  const bool holds_anything =
      std::filesystem::is_regular_file(path, error) && std::filesystem::file_size(path, error) > 0;
  if (holds_anything && on_held != HeldRun::replaced) {
    throw std::runtime_error(path + ": " +
                             describe_held(path, header, on_held == HeldRun::resumable));
  }
  return {path, header};
}

RunFile RunFile::resume(const std::string& path, const RunHeader& header,
                        const std::function<void(const RunStep&)>& each) {
  if (!std::filesystem::exists(path)) {
    return {path, header};
  }
  std::optional<RunStep> last;
  std::uint64_t size = 0;
  {
    std::ifstream stream(path, std::ios::binary);
    std::string first;
    std::getline(stream, first);
    if (stream.eof() && write_run_header(header).starts_with(first)) {
      return {path, header};  // The run was killed before the header was whole.
    }
    if (stream.eof() || !is_header_line_of(first, header)) {
      throw std::invalid_argument(
          path +
          ": holds a run of another scene, with other options or of another version; replace it "
          "with --force in place of --resume, or give another file");
    }
    stream.seekg(0);
    RunReader run(stream, path, header);
    while (std::optional<RunStep> step = run.next()) {
      each(*step);
      last = std::move(step);
    }
    size = run.size();
  }
  std::filesystem::resize_file(path, size);
  RunFile file(path, "ab");
  file.last_ = std::move(last);
  return file;
}

void RunFile::write(const RunStep& step) { write(write_run_step(step)); }

void RunFile::write(const std::string& line) {
  if (std::fwrite(line.data(), 1, line.size(), file_.get()) != line.size() ||
      std::fflush(file_.get()) != 0) {
    throw std::runtime_error(path_ + ": cannot write all of the run: " + std::strerror(errno));
  }
}

}  // namespace firstcontact::app
