#include <firstcontact/run_page/detail/glb_writer.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <stdexcept>
#include <utility>

namespace firstcontact::detail {
namespace {

constexpr int kFloat = 5126;        // GL_FLOAT
constexpr int kUnsignedInt = 5125;  // GL_UNSIGNED_INT

/// Appends a number, the least significant byte first, whatever the machine has.
void append(std::string& bytes, std::uint32_t number) {
  for (int k = 0; k < 4; ++k) {
    bytes += static_cast<char>(number >> (8 * k));
  }
}

void append_chunk(std::string& file, std::string chunk, std::string_view type, char filler) {
  chunk.resize((chunk.size() + 3) / 4 * 4, filler);
  append(file, static_cast<std::uint32_t>(chunk.size()));
  file += type;
  file += chunk;
}

}  // namespace

std::size_t GlbWriter::add_view(std::string_view bytes, Target target) {
  nlohmann::ordered_json view{
      {"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}};
  if (target != Target::none) {
    view["target"] = static_cast<int>(target);
  }
  views_.push_back(std::move(view));
  bytes_ += bytes;
  return views_.size() - 1;
}

std::size_t GlbWriter::add(std::span<const float> numbers, std::size_t width, Target target) {
  std::string bytes;
  for (const float number : numbers) {
    append(bytes, std::bit_cast<std::uint32_t>(number));
  }
  nlohmann::ordered_json least = nlohmann::ordered_json::array();
  nlohmann::ordered_json greatest = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < width; ++k) {
    float low = numbers[k];
    float high = numbers[k];
    for (std::size_t i = k; i < numbers.size(); i += width) {
      low = std::min(low, numbers[i]);
      high = std::max(high, numbers[i]);
    }
    least.push_back(low);
    greatest.push_back(high);
  }
  accessors_.push_back({{"bufferView", add_view(bytes, target)},
                        {"componentType", kFloat},
                        {"count", numbers.size() / width},
                        {"type", width == 1 ? "SCALAR" : "VEC" + std::to_string(width)},
                        {"min", std::move(least)},
                        {"max", std::move(greatest)}});
  return accessors_.size() - 1;
}

std::size_t GlbWriter::add(std::span<const std::uint32_t> indices) {
  std::string bytes;
  for (const std::uint32_t index : indices) {
    append(bytes, index);
  }
  accessors_.push_back({{"bufferView", add_view(bytes, Target::indices)},
                        {"componentType", kUnsignedInt},
                        {"count", indices.size()},
                        {"type", "SCALAR"}});
  return accessors_.size() - 1;
}

std::string GlbWriter::write(nlohmann::ordered_json document) const {
  document["asset"] = {{"version", "2.0"}, {"generator", "firstcontact"}};
  document["buffers"] = {{{"byteLength", bytes_.size()}}};
  document["bufferViews"] = views_;
  document["accessors"] = accessors_;
  std::string chunks;
  append_chunk(chunks,
               document.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace),
               "JSON", ' ');
  append_chunk(chunks, bytes_, std::string_view("BIN\0", 4), '\0');
  if (chunks.size() > std::numeric_limits<std::uint32_t>::max() - 12) {
    throw std::invalid_argument("the animation is larger than the 4 GiB that a .glb may have");
  }
  std::string file = "glTF";
  append(file, 2);  // Version.
  append(file, static_cast<std::uint32_t>(12 + chunks.size()));
  return file + chunks;
}

}  // namespace firstcontact::detail
