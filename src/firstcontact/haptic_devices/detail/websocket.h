/// @file
/// WebSockets without a socket: the handshake and the frames, for both sides.

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace firstcontact::detail {

/// The two ends of a connection. Clients mask their frames, servers do not.
enum class WebSocketSide { client, server };

/// The kinds of frames.
enum class WebSocketKind : std::uint8_t {
  continuation = 0x0,
  text = 0x1,
  binary = 0x2,
  close = 0x8,
  ping = 0x9,
  pong = 0xa,
};

/// A message of the other side.
struct WebSocketMessage {
  WebSocketKind kind = WebSocketKind::text;  ///< Never `continuation`.
  std::string payload;
};

/// Makes one frame with a whole message, from this side. A client passes a key of its own choice,
/// by which the frame is masked.
[[nodiscard]] std::string websocket_frame(WebSocketKind kind, std::string_view payload,
                                          std::optional<std::uint32_t> mask);

/// Cuts the bytes of the other side into messages.
///
/// A frame that breaks the rules of RFC 6455, or a message that is too long, ends the stream. Then
/// `failure` has the reason, and nothing more comes.
class WebSocketReader {
 public:
  /// Makes a reader.
  ///
  /// @param side  this end; frames come from the other one
  /// @param most  [byte]  greatest length of a message
  WebSocketReader(WebSocketSide side, std::size_t most) : side_(side), most_(most) {}

  void add(std::string_view bytes);

  /// Reads the next message; nothing until there are more bytes.
  [[nodiscard]] std::optional<WebSocketMessage> next();

  /// The reason why the stream ended; empty while it goes on.
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
  bool open_message_ = false;  // A message has begun whose last frame has not come yet.
  WebSocketMessage message_;
  std::string failure_;
};

/// The content of the head of an HTTP message.
struct HttpHead {
  std::size_t size = 0;  ///< [byte]  Size with the empty line at its end.
  std::string first_line;
  std::string upgrade;     ///< In lower case.
  std::string connection;  ///< In lower case.
  std::string accept;      ///< Sec-WebSocket-Accept.
  std::string key;         ///< Sec-WebSocket-Key.
  std::string version;     ///< Sec-WebSocket-Version.
  std::string extensions;  ///< Sec-WebSocket-Extensions.
  std::string origin;      ///< The page from which a browser connects.
  std::string host;        ///< The name of this side in the request, with its port.
};

/// Parses the head of an HTTP message; nothing until its empty line has come.
[[nodiscard]] std::optional<HttpHead> http_head(std::string_view bytes);

/// [byte]  Greatest size of a head; more is not taken for one.
inline constexpr std::size_t kMostHttpHead = 16'384;

/// Computes the answer to a key: base64 of a digest of it.
[[nodiscard]] std::string websocket_accept(std::string_view key);

/// Makes the request of a client.
///
/// @param key  base64 of 16 random bytes
[[nodiscard]] std::string websocket_request(const std::string& host, std::uint16_t port,
                                            const std::string& path, const std::string& key);

/// Finds why an answer of a server does not fit the key; empty if it does.
[[nodiscard]] std::string refused_because(const HttpHead& answer, const std::string& key);

/// Makes the answer of a server to the head of a request; nothing if that requests no WebSocket.
[[nodiscard]] std::optional<std::string> websocket_answer(const HttpHead& request);

}  // namespace firstcontact::detail
