#include <firstcontact/haptic_devices/detail/websocket.h>

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/haptic_devices/detail/sha1.h>

namespace firstcontact::detail {
namespace {

std::string hexadecimal(const std::array<std::uint8_t, 20>& digest) {
  std::string text;
  for (const std::uint8_t byte : digest) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

std::string bytes_of(std::initializer_list<int> values) {
  std::string bytes;
  for (const int value : values) {
    bytes += static_cast<char>(value);
  }
  return bytes;
}

/// The payloads of all messages in the bytes, for a client; or the failure.
std::vector<std::string> messages_of(const std::string& bytes, std::size_t most = 1 << 20) {
  WebSocketReader reader(WebSocketSide::client, most);
  reader.add(bytes);
  std::vector<std::string> payloads;
  while (const auto message = reader.next()) {
    payloads.push_back(message->payload);
  }
  if (!reader.failure().empty()) {
    payloads.push_back("failure: " + reader.failure());
  }
  return payloads;
}

using Payloads = std::vector<std::string>;

// The examples of FIPS 180 and a text of a million letters.
TEST(Sha1, GivesThePublishedDigests) {
  EXPECT_EQ(hexadecimal(sha1("")), "da39a3ee5e6b4b0d3255bfef95601890afd80709");
  EXPECT_EQ(hexadecimal(sha1("abc")), "a9993e364706816aba3e25717850c26c9cd0d89d");
  EXPECT_EQ(hexadecimal(sha1("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")),
            "84983e441c3bd26ebaae4aa1f95129e5e54670f1");
  EXPECT_EQ(hexadecimal(sha1(std::string(1'000'000, 'a'))),
            "34aa973cd4c4daa4f61eeb2bdbad27316534016f");
}

// The example of RFC 6455, section 1.3.
TEST(WebSocketHandshake, AnswersAsTheStandardSays) {
  EXPECT_EQ(websocket_accept("dGhlIHNhbXBsZSBub25jZQ=="), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
  const std::string request =
      websocket_request("localhost", 10001, "/", "dGhlIHNhbXBsZSBub25jZQ==");
  const auto head = http_head(request + "rest");
  ASSERT_TRUE(head);
  EXPECT_EQ(head->size, request.size());
  const auto answer = websocket_answer(*head);
  ASSERT_TRUE(answer);
  const auto answer_head = http_head(*answer);
  ASSERT_TRUE(answer_head);
  EXPECT_EQ(refused_because(*answer_head, "dGhlIHNhbXBsZSBub25jZQ=="), "");
  EXPECT_EQ(refused_because(*answer_head, "AAAAAAAAAAAAAAAAAAAAAA=="),
            "the answer is not one to our key");
}

TEST(WebSocketHandshake, RefusesOtherAnswers) {
  EXPECT_FALSE(http_head("HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\n"));
  const auto refused = http_head("HTTP/1.1 404 Not Found\r\n\r\n");
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused_because(*refused, "key"),
            "the answer is 'HTTP/1.1 404 Not Found', not 101 Switching Protocols");
  const auto plain = http_head("GET / HTTP/1.1\r\nHost: a\r\n\r\n");
  ASSERT_TRUE(plain);
  EXPECT_FALSE(websocket_answer(*plain));
}

// The examples of RFC 6455, section 5.7.
TEST(WebSocketReader, ReadsTheExamplesOfTheStandard) {
  EXPECT_EQ(messages_of(bytes_of({0x81, 0x05, 0x48, 0x65, 0x6c, 0x6c, 0x6f})), Payloads{"Hello"});
  EXPECT_EQ(messages_of(bytes_of({0x01, 0x03, 0x48, 0x65, 0x6c, 0x80, 0x02, 0x6c, 0x6f})),
            Payloads{"Hello"});
  WebSocketReader server(WebSocketSide::server, 100);
  server.add(bytes_of({0x81, 0x85, 0x37, 0xfa, 0x21, 0x3d, 0x7f, 0x9f, 0x4d, 0x51, 0x58}));
  const auto message = server.next();
  ASSERT_TRUE(message);
  EXPECT_EQ(message->payload, "Hello");
}

TEST(WebSocketReader, ReadsWhatTheWriterWrites) {
  for (const std::size_t size : {0, 1, 125, 126, 127, 65'535, 65'536, 200'000}) {
    const std::string payload(size, 'x');
    EXPECT_EQ(messages_of(websocket_frame(WebSocketKind::text, payload, std::nullopt)),
              Payloads{payload});
    WebSocketReader server(WebSocketSide::server, 1 << 20);
    server.add(websocket_frame(WebSocketKind::binary, payload, 0x9abcdef1));
    const auto message = server.next();
    ASSERT_TRUE(message) << size;
    EXPECT_EQ(message->payload, payload);
    EXPECT_EQ(message->kind, WebSocketKind::binary);
  }
}

TEST(WebSocketReader, DoesNotCareHowBytesArrive) {
  const std::string bytes =
      websocket_frame(WebSocketKind::text, "one", std::nullopt) +
      websocket_frame(WebSocketKind::ping, "two", std::nullopt) +
      websocket_frame(WebSocketKind::text, std::string(300, '3'), std::nullopt);
  WebSocketReader reader(WebSocketSide::client, 1000);
  int count = 0;
  for (const char byte : bytes) {
    reader.add({&byte, 1});
    while (reader.next()) {
      ++count;
    }
  }
  EXPECT_EQ(count, 3);
}

TEST(WebSocketReader, TakesAPingInsideOfAMessage) {
  EXPECT_EQ(messages_of(bytes_of({0x01, 0x01, 'a', 0x89, 0x01, 'p', 0x80, 0x01, 'b'})),
            (Payloads{"p", "ab"}));
}

TEST(WebSocketReader, EndsAtFramesThatBreakTheRules) {
  const auto failure = [](std::initializer_list<int> values) {
    return messages_of(bytes_of(values)).back();
  };
  EXPECT_EQ(failure({0xc1, 0x00}), "failure: a frame uses an extension that was not agreed");
  EXPECT_EQ(failure({0x81, 0x80, 0, 0, 0, 0}), "failure: a server has masked a frame");
  EXPECT_EQ(failure({0x83, 0x00}), "failure: a frame is of an unknown kind");
  EXPECT_EQ(failure({0x09, 0x00}), "failure: a control frame is longer than 125 bytes or in parts");
  EXPECT_EQ(failure({0x89, 126, 0, 126}),
            "failure: a control frame is longer than 125 bytes or in parts");
  EXPECT_EQ(failure({0x80, 0x00}), "failure: a message goes on that has not begun");
  EXPECT_EQ(failure({0x01, 0x00, 0x81, 0x00}), "failure: a message begins inside of another");
  EXPECT_EQ(failure({0x81, 126, 0, 5}),
            "failure: the length of a frame takes more bytes than it needs");
  EXPECT_EQ(failure({0x81, 127, 0, 0, 0, 0, 0, 0, 0, 5}),
            "failure: the length of a frame takes more bytes than it needs");
  EXPECT_EQ(failure({0x81, 127, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff}),
            "failure: a message is too long");
  EXPECT_EQ(failure({0x81, 0x01, 0xff}), "failure: a text is not UTF-8");
  EXPECT_EQ(messages_of(websocket_frame(WebSocketKind::text, "12345", std::nullopt), 4),
            Payloads{"failure: a message is too long"});
  WebSocketReader server(WebSocketSide::server, 100);
  server.add(bytes_of({0x81, 0x00}));
  EXPECT_FALSE(server.next());
  EXPECT_EQ(server.failure(), "a client has not masked a frame");
}

}  // namespace
}  // namespace firstcontact::detail
