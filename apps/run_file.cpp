#include "run_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <utility>

#include <firstcontact/record/read_run.h>
#include <firstcontact/record/write_run.h>

namespace firstcontact::app {

RunFile::RunFile(std::string path, const char* mode)
    : path_(std::move(path)), file_(std::fopen(path_.c_str(), mode)) {
  if (!file_) {
    throw std::runtime_error(path_ + ": cannot write this file: " + std::strerror(errno));
  }
}

RunFile::RunFile(const std::string& path, const RunHeader& header) : RunFile(path, "wb") {
  write(write_run_header(header));
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
    const std::string expected = write_run_header(header);
    if (stream.eof() && expected.starts_with(first)) {
      return {path, header};  // Killed before the header was whole.
    }
    if (first + '\n' != expected) {
      throw std::invalid_argument(
          path +
          ": holds a run of another scene, with other options or of another version; leave "
          "out --resume to begin anew");
    }
    stream.seekg(0);
    RunReader run(stream, path);
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
