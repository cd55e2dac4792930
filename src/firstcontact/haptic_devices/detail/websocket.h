/// @file
/// WebSockets without a socket: the handshake and the frames, for both sides.

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace firstcontact::detail {

/// The two ends of a connection. Clients mask what they send, servers do not.
enum class WebSocketSide { client, server };

enum class WebSocketKind : std::uint8_t {
  continuation = 0x0,
  text = 0x1,
  binary = 0x2,
  close = 0x8,
  ping = 0x9,
  pong = 0xa,
};

struct WebSocketMessage {
  WebSocketKind kind = WebSocketKind::text;  ///< Never `continuation`.
  std::string payload;
};

/// One frame with a whole message. The sender is this side; a client passes a key of its own choice
/// by which it masks the frame.
[[nodiscard]] std::string websocket_frame(WebSocketKind kind, std::string_view payload,
                                          std::optional<std::uint32_t> mask);

/// Cuts the bytes of the other side into messages.
///
/// A frame that breaks the rules of RFC 6455, or a message that is too long, ends the stream:
/// `failure` has the reason, and nothing more comes.
class WebSocketReader {
 public:
  /// @param side  this end; frames come from the other one
  /// @param most  [byte]  of a message
  WebSocketReader(WebSocketSide side, std::size_t most) : side_(side), most_(most) {}

  void add(std::string_view bytes);

  /// The next message, or nothing until there are more bytes.
  [[nodiscard]] std::optional<WebSocketMessage> next();

  /// Empty while all is well.
  [[nodiscard]] const std::string& failure() const { return failure_; }

 private:
  struct Frame {
    bool last = true;
    std::uint8_t opcode = 0;
    std::size_t header = 0;    // [byte]
    std::uint64_t length = 0;  // [byte]
    std::uint32_t mask = 0;
  };

  [[nodiscard]] std::optional<Frame> frame_header();
  [[nodiscard]] bool obeys_rules(const Frame& frame);
  [[nodiscard]] std::optional<WebSocketMessage> take(const Frame& frame);
  bool fail(const char* reason);

  WebSocketSide side_;
  std::size_t most_;
  std::string bytes_;
  std::size_t at_ = 0;
  bool open_message_ = false;  // A message has begun whose last frame has not come.
  WebSocketMessage message_;
  std::string failure_;
};

/// What the head of an HTTP message holds.
struct HttpHead {
  std::size_t size = 0;  ///< [byte]  With the empty line at its end.
  std::string first_line;
  std::string upgrade;     ///< In lower case.
  std::string connection;  ///< In lower case.
  std::string accept;      ///< Sec-WebSocket-Accept.
  std::string key;         ///< Sec-WebSocket-Key.
  std::string version;     ///< Sec-WebSocket-Version.
  std::string extensions;  ///< Sec-WebSocket-Extensions.
  std::string origin;      ///< The page from which a browser connects.
  std::string host;        ///< The name by which this side is called, with its port.
};

/// Parses the head of an HTTP message, or gives nothing until its empty line has come.
[[nodiscard]] std::optional<HttpHead> http_head(std::string_view bytes);

/// Bytes from which on a head is taken for no head.
inline constexpr std::size_t kMostHttpHead = 16'384;

/// The answer to a key: base64 of a digest of it.
[[nodiscard]] std::string websocket_accept(std::string_view key);

/// The request of a client.
///
/// @param key  base64 of 16 random bytes
[[nodiscard]] std::string websocket_request(const std::string& host, std::uint16_t port,
                                            const std::string& path, const std::string& key);

/// Why an answer of a server is not the one to the key; empty if it is.
[[nodiscard]] std::string refused_because(const HttpHead& answer, const std::string& key);

/// The answer of a server to the head of a request, or nothing if that asks for no WebSocket.
[[nodiscard]] std::optional<std::string> websocket_answer(const HttpHead& request);

}  // namespace firstcontact::detail
