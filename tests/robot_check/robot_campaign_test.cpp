// Random motions of real robots among boxes, held to FCL: its discrete test finds no collision at
// dense samples before the first contact, and its distance there is within the tolerance.
//
// FIRSTCONTACT_ROBOT_MOTIONS (default 4) is the number of motions of each robot. The whole campaign
// of 2,000 takes some ten minutes of one core:
//   FIRSTCONTACT_ROBOT_MOTIONS=334 build/ci/tests/robot_check/robot_campaign_test

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/robot_check/link_contact.h>
#include <firstcontact/robot_check/touching_links.h>
#include <firstcontact/robot_files/read_srdf.h>
#include <firstcontact/robot_files/read_urdf.h>

#include "robot_check/fcl_shape.h"
#include "robot_check/plain_robot_motion.h"
#include "support/data_dir.h"

namespace firstcontact::test {
namespace {

constexpr int kTries = 30;                // To start without a collision.
constexpr int kSamples = 200;             // Samples of each motion, before its first contact.
constexpr double kFclError = 1e-9;        // [m]  Error of FCL's distances in double precision.
constexpr double kTouchingAtRest = 1e-3;  // [m]  Pairs as near as that at rest are left out.

struct RobotFiles {
  const char* name;
  const char* urdf;
  const char* srdf;  // Empty where there is none.
};

constexpr RobotFiles kRobots[] = {
    {"puma", "robots/puma560_description/urdf/puma560_robot.urdf", ""},
    {"panda", "robots/moveit_resources_panda_description/urdf/panda.urdf",
     "robots/moveit_resources_panda_description/srdf/panda.srdf"},
    {"fanuc", "robots/moveit_resources_fanuc_description/urdf/fanuc.urdf",
     "robots/moveit_resources_fanuc_description/srdf/fanuc.srdf"},
    {"iiwa", "robots/kuka_iiwa/model.urdf", ""},
    {"nao", "robots/nao/nao.urdf", ""},
    {"allegro",
     "robots/example-robot-data/robots/allegro_hand_description/urdf/allegro_right_hand.urdf", ""},
};

/// The Puma is in the repository; the others are not.
std::optional<std::filesystem::path> folder_of(const RobotFiles& robot) {
  if (std::string(robot.name) == "puma") {
    return std::filesystem::path(FIRSTCONTACT_SOURCE_DIR) / "data";
  }
  return data_dir().empty() ? std::nullopt : std::optional(data_dir());
}

/// A piece of a link, or an obstacle in the world.
struct Piece {
  std::optional<std::size_t> link;
  Shape shape;
  FclShape fcl;
  Pose X_LG;
};

Eigen::Isometry3d isometry(const Pose& pose) {
  return Eigen::Translation3d(pose.position) * pose.rotation.normalized();
}

struct PiecePair {
  std::size_t a, b;
};

/// One robot among boxes: the pairs that may touch, and what the library and FCL say of them.
class Campaign {
 public:
  Campaign(const RobotFiles& files, const std::filesystem::path& folder)
      : model_(read_urdf(folder / files.urdf, {.package_roots = {folder / "robots"}})) {
    for (std::size_t l = 0; l < model_.links().size(); ++l) {
      for (const LinkGeometry& geometry : model_.links()[l].collision) {
        const Shape& shape = geometry.shape.value();
        pieces_.push_back({l, shape, FclShape(shape), geometry.X_LG});
      }
    }
    find_pairs(*files.srdf == '\0' ? RobotSemantics{} : read_srdf(folder / files.srdf, model_));
    for (const Eigen::Isometry3d& X : random_motion(model_, random_, 0.0, 0.0).places(0.0)) {
      size_ = std::max(size_, X.translation().norm());
    }
  }

  [[nodiscard]] const RobotModel& model() const { return model_; }

  /// Answers one motion and holds it to FCL.
  void check(std::uint64_t seed) {
    random_ = Random(seed);
    PlainRobotMotion plain = draw();
    for (int i = 0; i < kTries && collides(plain, 0.0); ++i) {
      plain = draw();
    }
    const double margin = random_.chance(0.5) ? 0.0 : 0.005;
    const Answer answer = ask(plain.motion(), margin);
    if (answer.verdict == Verdict::contact_at_start) {
      ++starts;
      hold_at(plain, answer, margin);
      return;
    }
    (answer.verdict == Verdict::free ? frees : contacts) += 1;
    ASSERT_NE(answer.verdict, Verdict::undecided);
    hold_before(plain, answer, margin);
    if (answer.verdict == Verdict::contact) {
      hold_at(plain, answer, margin);
    }
  }

  int starts = 0;
  int frees = 0;
  int contacts = 0;

 private:
  struct Answer {
    Verdict verdict = Verdict::free;
    double t = 1.0;
    double tolerance = 0.0;
    PiecePair pair = {0, 0};
  };

  void find_pairs(const RobotSemantics& semantics) {
    const std::vector<LinkPairIndex> touching = touching_links(at_rest(model_), kTouchingAtRest);
    link_pieces_ = pieces_.size();
    for (std::size_t a = 0; a < pieces_.size(); ++a) {
      for (std::size_t b = a + 1; b < pieces_.size(); ++b) {
        const std::size_t link = *pieces_[a].link;
        const std::size_t other = *pieces_[b].link;
        const bool left_out = link == other || model_.are_adjacent(link, other) ||
                              semantics.is_disabled(link, other) ||
                              std::find(touching.begin(), touching.end(),
                                        LinkPairIndex{std::min(link, other),
                                                      std::max(link, other)}) != touching.end();
        if (!left_out) {
          pairs_.push_back({a, b});
        }
      }
    }
    link_pairs_ = pairs_.size();
  }

  /// Among boxes of its own.
  PlainRobotMotion draw() {
    pieces_.erase(pieces_.begin() + static_cast<std::ptrdiff_t>(link_pieces_), pieces_.end());
    pairs_.resize(link_pairs_);
    for (int i = 0; i < 2; ++i) {
      add_box();
    }
    const double spread = random_.uniform(0.0, 1.0);
    return random_motion(model_, random_, spread, random_.uniform(0.2, 2.0));
  }

  /// Whether FCL sees a collision.
  [[nodiscard]] bool collides(const PlainRobotMotion& plain, double t) const {
    const std::vector<Eigen::Isometry3d> links = plain.places(t);
    return std::any_of(pairs_.begin(), pairs_.end(), [&](const PiecePair& pair) {
      const Piece& a = pieces_[pair.a];
      const Piece& b = pieces_[pair.b];
      return a.fcl.collides(place(links, a), b.fcl, place(links, b));
    });
  }

  /// A hollow box somewhere in reach.
  void add_box() {
    Mesh mesh = make_box(random_.uniform(0.1, 0.5) * size_ * Eigen::Vector3d::Ones()).mesh();
    const Shape shape(std::move(mesh));
    const Pose X{random_.uniform(0.3, 1.5) * size_ * random_.direction(), random_.rotation()};
    for (std::size_t a = 0; a < link_pieces_; ++a) {
      // The root rests, as the box does: it would only hide all that comes later.
      if (pieces_[a].link != model_.root()) {
        pairs_.push_back({a, pieces_.size()});
      }
    }
    pieces_.push_back({std::nullopt, shape, FclShape(shape), X});
  }

  [[nodiscard]] RelativeLinkMotion motions(const RobotMotion& motion, const PiecePair& pair) const {
    const Piece& a = pieces_[pair.a];
    const Piece& b = pieces_[pair.b];
    if (!b.link) {
      return {motion.link(*a.link).then(precise(a.X_LG)), LinkMotion(Motion::fixed(b.X_LG))};
    }
    const RelativeLinkMotion links = motion.relative(*a.link, *b.link);
    return {links.A.then(precise(a.X_LG)), links.B.then(precise(b.X_LG))};
  }

  /// The first contact of all pairs.
  Answer ask(const RobotMotion& motion, double margin) {
    Answer first;
    FirstContactOptions options;
    options.margin = margin;
    options.contacts = ContactState::none;
    for (const PiecePair& pair : pairs_) {
      const RelativeLinkMotion links = motions(motion, pair);
      const FirstContactResult result = first_contact(
          {pieces_[pair.a].shape, links.A}, {pieces_[pair.b].shape, links.B}, workspace_, options);
      if (result.verdict != Verdict::free &&
          (first.verdict == Verdict::free || result.t < first.t)) {
        first = {result.verdict, result.t, result.tolerance_used, pair};
      }
    }
    return first;
  }

  [[nodiscard]] Eigen::Isometry3d place(const std::vector<Eigen::Isometry3d>& links,
                                        const Piece& piece) const {
    return piece.link ? links[*piece.link] * isometry(piece.X_LG) : isometry(piece.X_LG);
  }

  void hold_before(const PlainRobotMotion& plain, const Answer& answer, double margin) const {
    const bool free = answer.verdict == Verdict::free;
    for (int i = 0; i < kSamples + (free ? 1 : 0); ++i) {
      const double t = answer.t * i / kSamples;
      const std::vector<Eigen::Isometry3d> links = plain.places(t);
      for (const PiecePair& pair : pairs_) {
        const Piece& a = pieces_[pair.a];
        const Piece& b = pieces_[pair.b];
        ASSERT_FALSE(a.fcl.collides(place(links, a), b.fcl, place(links, b)))
            << what(pair) << " at " << t << " before " << answer.t;
        // Distances cost more: at fewer times.
        if (margin > 0.0 && i % (kSamples / 4) == 0) {
          ASSERT_GE(a.fcl.distance(place(links, a), b.fcl, place(links, b)), margin - kFclError)
              << what(pair) << " at " << t << " before " << answer.t;
        }
      }
    }
  }

  void hold_at(const PlainRobotMotion& plain, const Answer& answer, double margin) const {
    const std::vector<Eigen::Isometry3d> links = plain.places(answer.t);
    const Piece& a = pieces_[answer.pair.a];
    const Piece& b = pieces_[answer.pair.b];
    EXPECT_LE(a.fcl.distance(place(links, a), b.fcl, place(links, b)),
              margin + answer.tolerance + kFclError)
        << what(answer.pair) << " at " << answer.t;
  }

  [[nodiscard]] std::string what(const PiecePair& pair) const {
    const auto name = [&](const Piece& piece) {
      return piece.link ? model_.links()[*piece.link].name : std::string("box");
    };
    return name(pieces_[pair.a]) + " and " + name(pieces_[pair.b]);
  }

  RobotModel model_;
  std::vector<Piece> pieces_;  // Those of links first.
  std::vector<PiecePair> pairs_;
  std::size_t link_pieces_ = 0;
  std::size_t link_pairs_ = 0;
  double size_ = 0.0;  // [m]  Of the robot.
  Random random_{0};
  Workspace workspace_;
};

int motion_count() {
  const char* value = std::getenv("FIRSTCONTACT_ROBOT_MOTIONS");
  return value == nullptr ? 4 : std::atoi(value);
}

class RobotCampaign : public testing::TestWithParam<RobotFiles> {};

TEST_P(RobotCampaign, IsHeldToFcl) {
  const std::optional<std::filesystem::path> folder = folder_of(GetParam());
  if (!folder) {
    GTEST_SKIP() << "needs FIRSTCONTACT_DATA_DIR";
  }
  Campaign campaign(GetParam(), *folder);
  const int count = motion_count();
  for (int i = 0; i < count && !HasFatalFailure(); ++i) {
    SCOPED_TRACE("motion " + std::to_string(i));
    campaign.check(static_cast<std::uint64_t>(i));
  }
  std::printf("%s: %d motions free, %d in contact, %d in contact at the start\n", GetParam().name,
              campaign.frees, campaign.contacts, campaign.starts);
  EXPECT_GE(campaign.frees + campaign.contacts, count / 2) << "most motions start in contact";
}

INSTANTIATE_TEST_SUITE_P(Robots, RobotCampaign, testing::ValuesIn(kRobots),
                         [](const testing::TestParamInfo<RobotFiles>& parameter) {
                           return std::string(parameter.param.name);
                         });

}  // namespace
}  // namespace firstcontact::test
