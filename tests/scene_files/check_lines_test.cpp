#include <firstcontact/scene_files/check_lines.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <future>
#include <stop_token>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_result.h>

#include "scene/scene_text.h"

namespace firstcontact {
namespace {

using test::body;
using test::falling;
using test::scene;

/// A folder with a mesh of some hundred triangles; it is gone with the test.
class CheckLines : public testing::Test {
 protected:
  CheckLines() {
    std::filesystem::create_directory(folder_);
    std::ofstream mesh(mesh_);
    constexpr int kSide = 12;
    for (int i = 0; i <= kSide; ++i) {
      for (int j = 0; j <= kSide; ++j) {
        mesh << "v " << i << " " << j << " " << (i * j) % 3 << "\n";
      }
    }
    for (int i = 0; i < kSide; ++i) {
      for (int j = 1; j <= kSide; ++j) {
        const int k = i * (kSide + 1) + j;
        mesh << "f " << k << " " << k + 1 << " " << k + kSide + 1 << "\n";
      }
    }
  }
  ~CheckLines() override { std::filesystem::remove_all(folder_); }

  /// Every fifth scene is bad; the others fall from different heights.
  [[nodiscard]] static std::string line(std::size_t number) {
    if (number % 5 == 0) {
      return "{";
    }
    const std::string height = std::to_string(1 + number % 7);
    return scene(R"({"name": "ground", "shape": {"mesh": "mesh.obj"}},)" +
                 body("stone", falling(height, "-4")));
  }

  [[nodiscard]] std::vector<LineAnswer> answers(std::size_t count,
                                                const CheckLinesOptions& options) const {
    std::size_t number = 0;
    std::vector<LineAnswer> taken;
    check_lines(
        folder_ / "s.jsonl",
        [&]() -> std::optional<SceneLine> {
          if (number == count) {
            return std::nullopt;
          }
          ++number;
          return SceneLine{.number = number, .text = line(number)};
        },
        [&](const LineAnswer& answer) { taken.push_back(answer); }, options);
    return taken;
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("check_lines_test." + std::to_string(getpid()));
  std::filesystem::path mesh_ = folder_ / "mesh.obj";
};

TEST_F(CheckLines, AnswersInOrderAndAlikeForEveryNumberOfThreads) {
  constexpr std::size_t kCount = 300;
  const std::vector<LineAnswer> alone = answers(kCount, {.threads = 1});
  ASSERT_EQ(alone.size(), kCount);
  for (std::size_t k = 0; k < kCount; ++k) {
    EXPECT_EQ(alone[k].line, k + 1);
    EXPECT_EQ(alone[k].verdict.has_value(), (k + 1) % 5 != 0) << k;
    EXPECT_EQ(alone[k].error.empty(), (k + 1) % 5 != 0) << k;
    EXPECT_EQ(read_summary(alone[k].text, "text").verdict, alone[k].verdict) << k;
    EXPECT_EQ(read_summary(alone[k].text, "text").line, alone[k].line) << k;
  }
  for (const std::size_t threads : {0, 2, 8}) {
    const std::vector<LineAnswer> together = answers(kCount, {.threads = threads});
    ASSERT_EQ(together.size(), kCount);
    for (std::size_t k = 0; k < kCount; ++k) {
      ASSERT_EQ(together[k].text, alone[k].text);
    }
  }
}

TEST_F(CheckLines, NamesTheBadLine) {
  const std::vector<LineAnswer> five = answers(5, {});
  const std::string file = (folder_ / "s.jsonl").string();
  EXPECT_EQ(five[4].error, file + ":5: expected a key in double quotes, got the end of the text");
}

TEST_F(CheckLines, AdjustsTheOptionsOfEveryScene) {
  const auto far = [](SceneOptions& options) { options.margin = 100.0; };
  for (const LineAnswer& answer : answers(4, {.adjust = far})) {
    EXPECT_EQ(answer.verdict, Verdict::contact_at_start);
  }
}

// The lines that were handed over before a stop are the beginning of all lines.
TEST_F(CheckLines, EndsWithWholeAnswersAtAStop) {
  const std::vector<LineAnswer> whole = answers(1000, {});
  std::stop_source source;
  std::size_t adjusted = 0;
  const auto stop_soon = [&](SceneOptions&) {
    if (++adjusted == 100) {
      source.request_stop();
    }
  };
  const std::vector<LineAnswer> some =
      answers(1000, {.threads = 1, .stop = source.get_token(), .adjust = stop_soon});
  EXPECT_LT(some.size(), whole.size());
  for (std::size_t k = 0; k < some.size(); ++k) {
    EXPECT_EQ(some[k].text, whole[k].text);
  }
}

TEST_F(CheckLines, PassesOnWhatItsCallerThrows) {
  EXPECT_THROW(check_lines(
                   "s.jsonl", [] { return SceneLine{.number = 1, .text = line(1)}; },
                   [](const LineAnswer&) { throw std::runtime_error("full"); }),
               std::runtime_error);
  std::size_t number = 0;
  const auto broken = [&]() -> SceneLine {
    if (++number == 50) {
      throw std::runtime_error("unplugged");
    }
    return {.number = number, .text = line(1)};
  };
  EXPECT_THROW(check_lines("s.jsonl", broken, [](const LineAnswer&) {}), std::runtime_error);
}

TEST_F(CheckLines, LoadsAMeshOnceForAllThreads) {
  ShapeCache cache;
  std::vector<std::future<const Mesh*>> loads;
  for (int k = 0; k < 8; ++k) {
    loads.push_back(std::async(std::launch::async, [&] {
      BodyShape shape;
      shape.source = MeshFile{.path = mesh_};
      return &cache.load(shape).shape.mesh();
    }));
  }
  const Mesh* first = loads[0].get();
  for (std::size_t k = 1; k < loads.size(); ++k) {
    EXPECT_EQ(loads[k].get(), first);
  }
}

}  // namespace
}  // namespace firstcontact
