#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/haptic_devices/detail/haply_protocol.h>
#include <firstcontact/haptic_devices/detail/websocket.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/parse_json.h>

#include "fuzz/fuzz_reader.h"
#include "fuzz/text_mutator.h"

namespace {

using namespace firstcontact::detail;
using firstcontact::test::require;

void fuzz_message(std::string_view text) {
  try {
    const HaplyMessage message = parse_haply_message(text, {});
    require(message.velocity.allFinite());
    require(!message.position || message.position->cwiseAbs().maxCoeff() <= 10.0);
    require(!message.orientation || std::abs(message.orientation->norm() - 1.0) < 1e-9);
    const Eigen::Vector3d force = message.position.value_or(message.velocity);
    (void)parse_json(haply_force(message.device_id, force, "vector", message.model), "force");
  } catch (const firstcontact::ParseError& error) {
    require(std::strchr(error.what(), '\n') == nullptr);
  }
}

std::vector<std::string> messages_of(std::string_view bytes, WebSocketSide side,
                                     std::size_t chunk) {
  WebSocketReader reader(side, 5000);
  std::vector<std::string> messages;
  while (!bytes.empty()) {
    reader.add(bytes.substr(0, chunk));
    bytes.remove_prefix(std::min(chunk, bytes.size()));
    while (const auto message = reader.next()) {
      require(message->payload.size() <= 5000);
      messages.push_back(message->payload);
    }
  }
  messages.push_back(reader.failure());
  return messages;
}

}  // namespace

constexpr std::array<std::string_view, 22> kWords = {"session_id",
                                                     "inverse3",
                                                     "device_id",
                                                     "config",
                                                     "type",
                                                     "state",
                                                     "status",
                                                     "ready",
                                                     "cursor_position",
                                                     "cursor_velocity",
                                                     "orientation",
                                                     "buttons",
                                                     "button",
                                                     "verse_grip",
                                                     "wireless_verse_grip",
                                                     "custom_verse_grip",
                                                     "Upgrade: websocket",
                                                     "Connection: Upgrade",
                                                     "Sec-WebSocket-Key",
                                                     "Sec-WebSocket-Accept",
                                                     "HTTP/1.1 101",
                                                     "\r\n\r\n"};

/// Any bytes give messages, or a reason why not. The first byte picks what they are taken for.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (data[0] == 'h') {
    if (const auto head = http_head(bytes)) {
      require(head->size <= bytes.size());
      (void)refused_because(*head, "dGhlIHNhbXBsZSBub25jZQ==");
      (void)websocket_answer(*head);
    }
  } else if (data[0] == 'j' || data[0] == '{') {
    fuzz_message(data[0] == 'j' ? bytes : std::string_view(bytes.data() - 1, size));
  } else {
    const auto side = data[0] % 2 == 0 ? WebSocketSide::client : WebSocketSide::server;
    require(messages_of(bytes, side, size) ==
            messages_of(bytes, side, std::size_t{1} + data[0] / 8));
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  auto* text = reinterpret_cast<char*>(data);
  if (size < 2 || most < 2 || seed % 16 == 0) {
    return firstcontact::test::mutate_text(text, size, most, seed, kWords);
  }
  return 1 + firstcontact::test::mutate_text(text + 1, size - 1, most - 1, seed, kWords);
}
