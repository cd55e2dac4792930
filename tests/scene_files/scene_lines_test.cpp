#include <firstcontact/scene_files/scene_lines.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/text/parse_error.h>

#include "scene/robot_text.h"

namespace firstcontact {
namespace {

class LinesOfScenes : public testing::Test {
 protected:
  /// The scenes of a file of this text by number, and the digest at its end.
  std::vector<std::pair<std::size_t, std::string>> read(const std::string& text) {
    folder_.write("s.jsonl", text);
    SceneLines lines(folder_.path() / "s.jsonl");
    std::vector<std::pair<std::size_t, std::string>> found;
    while (const auto line = lines.next()) {
      found.emplace_back(line->number, line->text);
    }
    EXPECT_FALSE(lines.next());
    digest_ = lines.digest();
    return found;
  }

  std::string digest_of(const std::string& text) {
    (void)read(text);
    return digest_;
  }

  test::ArmFolder folder_;
  std::string digest_;
};

using Numbered = std::vector<std::pair<std::size_t, std::string>>;

TEST_F(LinesOfScenes, AreNumberedAsInTheirFile) {
  const Numbered two{{1, "{}"}, {4, "{\"a\": 1}"}};
  EXPECT_EQ(read("{}\n\n \t\r\n{\"a\": 1}\n"), two);
  EXPECT_EQ(read("{}\n\n\n{\"a\": 1}"), two);  // Also without an end of line.
  EXPECT_EQ(read(""), Numbered{});
  EXPECT_EQ(read("\n\n"), Numbered{});
  EXPECT_EQ(read("{}\r\n"), (Numbered{{1, "{}\r"}}));
}

TEST_F(LinesOfScenes, AreNamedByADigestOfAllOfThem) {
  const std::string digest = digest_of("{}\n{\"a\": 1}\n");
  EXPECT_EQ(digest.size(), 64u);
  EXPECT_EQ(digest_of("{}\n{\"a\": 1}"), digest);
  EXPECT_NE(digest_of("{}\n\n{\"a\": 1}\n"), digest);
  EXPECT_NE(digest_of("{\"a\": 1}\n{}\n"), digest);
  EXPECT_NE(digest_of("{}\n{\"a\": 1} \n"), digest);
}

TEST_F(LinesOfScenes, RefuseAFileThatCannotBeRead) {
  const std::filesystem::path none = folder_.path() / "none.jsonl";
  SceneLines lines(none);
  try {
    (void)lines.next();
    ADD_FAILURE() << "accepted";
  } catch (const ParseError& error) {
    EXPECT_EQ(std::string(error.what()),
              none.string() + ": expected a file of scenes, cannot read this one");
  }
}

}  // namespace
}  // namespace firstcontact
