#include <firstcontact/haptic_devices/detail/websocket.h>

#include <algorithm>
#include <utility>

#include <firstcontact/haptic_devices/detail/recording_head.h>
#include <firstcontact/haptic_devices/detail/sha1.h>
#include <firstcontact/text/ascii.h>
#include <firstcontact/text/base64.h>
#include <firstcontact/text/text_cursor.h>
#include <firstcontact/text/utf8.h>

// Source of all: I. Fette, A. Melnikov, "The WebSocket Protocol", RFC 6455, 2011.
namespace firstcontact::detail {
namespace {

constexpr std::uint8_t kLastFrame = 0x80;
constexpr std::uint8_t kReserved = 0x70;
constexpr std::uint8_t kMasked = 0x80;
constexpr std::size_t kMostControl = 125;

/// Finds the byte of the mask for a byte of the payload.
std::uint8_t mask_byte(std::uint32_t mask, std::size_t at) {
  return static_cast<std::uint8_t>(mask >> (24 - 8 * (at % 4)));
}

void append_big_endian(std::string& bytes, std::uint64_t value, int count) {
  for (int shift = 8 * (count - 1); shift >= 0; shift -= 8) {
    bytes += static_cast<char>(value >> shift & 0xff);
  }
}

bool has_token(std::string_view list, std::string_view token) {
  while (!list.empty()) {
    const std::size_t comma = list.find(',');
    if (trimmed(list.substr(0, comma)) == token) {
      return true;
    }
    list.remove_prefix(comma == std::string_view::npos ? list.size() : comma + 1);
  }
  return false;
}

bool is_opcode(std::uint8_t opcode) { return opcode <= 0x2 || (opcode >= 0x8 && opcode <= 0xa); }

}  // namespace

std::string websocket_frame(WebSocketKind kind, std::string_view payload,
                            std::optional<std::uint32_t> mask) {
  const std::uint8_t masked = mask ? kMasked : 0;
  std::string frame;
  frame.reserve(payload.size() + 14);
  frame += static_cast<char>(kLastFrame | static_cast<std::uint8_t>(kind));
  if (payload.size() <= kMostControl) {
    frame += static_cast<char>(masked | payload.size());
  } else if (payload.size() <= 0xffff) {
    frame += static_cast<char>(masked | 126);
    append_big_endian(frame, payload.size(), 2);
  } else {
    frame += static_cast<char>(masked | 127);
    append_big_endian(frame, payload.size(), 8);
  }
  if (!mask) {
    return frame.append(payload);
  }
  append_big_endian(frame, *mask, 4);
  for (std::size_t i = 0; i < payload.size(); ++i) {
    frame += static_cast<char>(static_cast<std::uint8_t>(payload[i]) ^ mask_byte(*mask, i));
  }
  return frame;
}

bool WebSocketReader::fail(const char* reason) {
  failure_ = reason;
  bytes_.clear();
  at_ = 0;
  return false;
}

void WebSocketReader::add(std::string_view bytes) {
  if (!failure_.empty()) {
    return;
  }
  bytes_.erase(0, at_);
  at_ = 0;
  bytes_.append(bytes);
}

std::optional<WebSocketReader::Frame> WebSocketReader::frame_header() {
  const std::size_t there = bytes_.size() - at_;
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes_[at_ + i]); };
  if (there < 2) {
    return std::nullopt;
  }
  Frame frame;
  frame.last = (byte(0) & kLastFrame) != 0;
  frame.opcode = byte(0) & 0xf;
  if ((byte(0) & kReserved) != 0) {
    fail("a frame uses an extension that was not agreed");
    return std::nullopt;
  }
  const bool masked = (byte(1) & kMasked) != 0;
  if (masked != (side_ == WebSocketSide::server)) {
    fail(masked ? "a server has masked a frame" : "a client has not masked a frame");
    return std::nullopt;
  }
  const std::uint8_t length = byte(1) & 0x7f;
  const std::size_t extra = length == 127 ? 8 : length == 126 ? 2 : 0;
  frame.header = 2 + extra + (masked ? 4 : 0);
  if (there < frame.header) {
    return std::nullopt;
  }
  frame.length = extra == 0 ? length : 0;
  for (std::size_t i = 0; i < extra; ++i) {
    frame.length = frame.length << 8 | byte(2 + i);
  }
  if ((extra == 2 && frame.length < 126) || (extra == 8 && frame.length <= 0xffff)) {
    fail("the length of a frame takes more bytes than it needs");
    return std::nullopt;
  }
  for (std::size_t i = 0; masked && i < 4; ++i) {
    frame.mask = frame.mask << 8 | byte(2 + extra + i);
  }
  return frame;
}

bool WebSocketReader::obeys_rules(const Frame& frame) {
  if (!is_opcode(frame.opcode)) {
    return fail("a frame is of an unknown kind");
  }
  if (frame.opcode >= 0x8) {
    return frame.last && frame.length <= kMostControl
               ? true
               : fail("a control frame is longer than 125 bytes or in parts");
  }
  if ((frame.opcode == 0) != open_message_) {
    return fail(open_message_ ? "a message begins inside of another"
                              : "a message goes on that has not begun");
  }
  const std::size_t so_far = open_message_ ? message_.payload.size() : 0;
  return frame.length <= most_ - so_far ? true : fail("a message is too long");
}

std::optional<WebSocketMessage> WebSocketReader::take(const Frame& frame) {
  std::string payload = bytes_.substr(at_ + frame.header, frame.length);
  at_ += frame.header + frame.length;
  if (side_ == WebSocketSide::server) {
    for (std::size_t i = 0; i < payload.size(); ++i) {
      payload[i] =
          static_cast<char>(static_cast<std::uint8_t>(payload[i]) ^ mask_byte(frame.mask, i));
    }
  }
  if (frame.opcode >= 0x8) {
    return WebSocketMessage{static_cast<WebSocketKind>(frame.opcode), std::move(payload)};
  }
  if (!open_message_) {
    message_ = {static_cast<WebSocketKind>(frame.opcode), {}};
  }
  message_.payload += payload;
  open_message_ = !frame.last;
  if (open_message_) {
    return std::nullopt;
  }
  if (message_.kind == WebSocketKind::text &&
      find_not_utf8(message_.payload) != message_.payload.size()) {
    fail("a text is not UTF-8");
    return std::nullopt;
  }
  return std::move(message_);
}

std::optional<WebSocketMessage> WebSocketReader::next() {
  while (failure_.empty()) {
    const std::optional<Frame> frame = frame_header();
    if (!frame || !obeys_rules(*frame) || bytes_.size() - at_ - frame->header < frame->length) {
      return std::nullopt;
    }
    if (std::optional<WebSocketMessage> message = take(*frame)) {
      return message;
    }
  }
  return std::nullopt;
}

std::optional<HttpHead> http_head(std::string_view bytes) {
  const std::size_t end = bytes.find("\r\n\r\n");
  if (end == std::string_view::npos) {
    return std::nullopt;
  }
  HttpHead head;
  head.size = end + 4;
  std::string_view rest = bytes.substr(0, end + 2);
  while (!rest.empty()) {
    const std::size_t line_end = rest.find("\r\n");
    const std::string_view line = rest.substr(0, line_end);
    rest.remove_prefix(line_end + 2);
    const std::size_t colon = line.find(':');
    if (head.first_line.empty()) {
      head.first_line = line;
      continue;
    }
    if (colon == std::string_view::npos) {
      continue;
    }
    const std::string name = lower(line.substr(0, colon));
    const std::string value(trimmed(line.substr(colon + 1)));
    if (name == "upgrade") {
      head.upgrade = lower(value);
    } else if (name == "connection") {
      head.connection = lower(value);
    } else if (name == "sec-websocket-accept") {
      head.accept = value;
    } else if (name == "sec-websocket-key") {
      head.key = value;
    } else if (name == "sec-websocket-version") {
      head.version = value;
    } else if (name == "sec-websocket-extensions") {
      head.extensions = value;
    } else if (name == "origin") {
      head.origin = value;
    } else if (name == "host") {
      head.host = value;
    }
  }
  return head;
}

std::string websocket_accept(std::string_view key) {
  const auto digest = sha1(std::string(key) + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11");
  return base64(digest);
}

std::string websocket_request(const std::string& host, std::uint16_t port, const std::string& path,
                              const std::string& key) {
  return "GET " + path + " HTTP/1.1\r\nHost: " + host + ":" + std::to_string(port) +
         "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: " + key +
         "\r\nSec-WebSocket-Version: 13\r\n\r\n";
}

std::string refused_because(const HttpHead& answer, const std::string& key) {
  if (!answer.first_line.starts_with("HTTP/1.1 101")) {
    return "the answer is " + detail::quoted(answer.first_line) + ", not 101 Switching Protocols";
  }
  if (answer.upgrade != "websocket" || !has_token(answer.connection, "upgrade")) {
    return "the answer does not upgrade the connection to a WebSocket";
  }
  if (answer.accept != websocket_accept(key)) {
    return "the answer is not one to our key";
  }
  return answer.extensions.empty() ? "" : "the answer uses extensions that nobody asked for";
}

std::optional<std::string> websocket_answer(const HttpHead& request) {
  const std::optional<std::string> key = from_base64(request.key);
  if (!request.first_line.starts_with("GET ") || !has_token(request.upgrade, "websocket") ||
      !has_token(request.connection, "upgrade") || request.version != "13" || !key ||
      key->size() != 16) {
    return std::nullopt;
  }
  return "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
         "Sec-WebSocket-Accept: " +
         websocket_accept(request.key) + "\r\n\r\n";
}

}  // namespace firstcontact::detail
