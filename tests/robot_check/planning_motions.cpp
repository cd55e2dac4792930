// The straight joint-space motions of planning problems: which of them collide, and which of these
// a planner that samples would take for free?
//
//   planning_motions [--every N]
//
// Needs FIRSTCONTACT_DATA_DIR. Asks firstcontact about the motion from start to goal of each
// problem of MotionBenchMaker for the Panda (of every N-th one), and FCL about the same geometry
// and the same pairs at samples of it: so many that the joint that goes farthest moves by 1 or 5
// degrees from one to the next. Forward kinematics for FCL share no code with the library. Prints
// a table. Fails if a sample before the certified time collides, if FCL's distance at it exceeds
// the tolerance, or if a contact of the samples was not found.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/core.h>

#include <firstcontact/robot_check/check_robots.h>
#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene_files/robot_question.h>

#include "robot_check/fcl_shape.h"
#include "robot_check/plain_robot_motion.h"
#include "support/data_dir.h"

namespace firstcontact::test {
namespace {

namespace fs = std::filesystem;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::array<double, 2> kSteps = {1.0 * kDegree, 5.0 * kDegree};
constexpr double kFineStep = 0.01 * kDegree;
constexpr double kFclError = 1e-9;  // [m]  Of FCL's distances in double precision.

Eigen::Isometry3d isometry(const Pose& pose) {
  return Eigen::Translation3d(pose.position) * pose.rotation.normalized();
}

/// A shape as FCL sees it. FCL's meshes are surfaces; what is inside of a convex solid collides
/// too.
class SampledShape {
 public:
  explicit SampledShape(const Shape& shape) : fcl_(shape), shape_(shape) {}

  [[nodiscard]] bool collides(const Eigen::Isometry3d& X_WA, const SampledShape& B,
                              const Eigen::Isometry3d& X_WB) const {
    return fcl_.collides(X_WA, B.fcl_, X_WB) || holds(X_WA, B, X_WB) || B.holds(X_WB, *this, X_WA);
  }

  [[nodiscard]] double distance(const Eigen::Isometry3d& X_WA, const SampledShape& B,
                                const Eigen::Isometry3d& X_WB) const {
    return fcl_.distance(X_WA, B.fcl_, X_WB);
  }

 private:
  /// Returns whether a convex solid holds the other shape; boxes and prisms are the only ones here.
  [[nodiscard]] bool holds(const Eigen::Isometry3d& X_WA, const SampledShape& B,
                           const Eigen::Isometry3d& X_WB) const {
    if (!shape_.is_solid()) {
      return false;
    }
    const Mesh& mesh = shape_.mesh();
    const Eigen::Vector3d p = X_WA.inverse() * (X_WB * B.shape_.mesh().vertices.front());
    return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& triangle) {
      const Eigen::Vector3d& a = mesh.vertices[triangle[0]];
      const Eigen::Vector3d normal =
          (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a);
      return normal.dot(p - a) <= 0.0;
    });
  }

  FclShape fcl_;
  Shape shape_;
};

/// A piece of a member of the scene.
struct Piece {
  std::shared_ptr<const SampledShape> shape;
  std::optional<std::size_t> link;
  Eigen::Isometry3d X;  ///< In the link, or in the world.
};

/// The same scene as FCL sees it.
class SampledScene {
 public:
  using Shapes = std::map<const Mesh*, std::shared_ptr<const SampledShape>>;

  /// @param shapes  those of the robot, from problem to problem
  SampledScene(const LoadedScene& loaded, Shapes& shapes)
      : scene_(*loaded.robots), plain_(plain_motion(loaded)) {
    for (std::size_t member = 0; member < scene_.size(); ++member) {
      std::vector<Piece>& pieces = pieces_.emplace_back();
      for (const MemberGeometry& geometry : scene_.geometries(member)) {
        pieces.push_back(piece(member, geometry, shapes));
      }
    }
    for (std::size_t a = 0; a < scene_.size(); ++a) {
      for (std::size_t b = a + 1; b < scene_.size(); ++b) {
        if (scene_.margin({a, b})) {
          pairs_.push_back({a, b});
        }
      }
    }
  }

  /// [rad or m]  The way of the joint that goes farthest.
  [[nodiscard]] double length() const {
    double greatest = 0.0;
    for (std::size_t k = 0; k < plain_.from.size(); ++k) {
      greatest = std::max(greatest, std::abs(plain_.to[k] - plain_.from[k]));
    }
    return greatest;
  }

  [[nodiscard]] bool collides(double t) const {
    const std::vector<Eigen::Isometry3d> links = plain_.places(t);
    return std::any_of(pairs_.begin(), pairs_.end(), [&](const BodyPair& pair) {
      return any_piece(pair, [&](const Piece& a, const Piece& b) {
        return a.shape->collides(place(links, a), *b.shape, place(links, b));
      });
    });
  }

  /// [m]  Of a pair.
  [[nodiscard]] double distance(const BodyPair& pair, double t) const {
    const std::vector<Eigen::Isometry3d> links = plain_.places(t);
    double least = INFINITY;
    (void)any_piece(pair, [&](const Piece& a, const Piece& b) {
      least = std::min(least, a.shape->distance(place(links, a), *b.shape, place(links, b)));
      return false;
    });
    return least;
  }

 private:
  Piece piece(std::size_t member, const MemberGeometry& geometry, Shapes& shapes) const {
    const auto link = scene_.robot_link(member);
    if (!link) {
      return {std::make_shared<SampledShape>(geometry.shape), std::nullopt,
              isometry(scene_.body_motion(member).pose(0.0)) * isometry(geometry.X_MG)};
    }
    auto& shape = shapes[&geometry.shape.mesh()];
    if (!shape) {
      shape = std::make_shared<SampledShape>(geometry.shape);
    }
    return {shape, link->link, isometry(geometry.X_MG)};
  }

  /// From the first point of the trajectory to its last; what it does not name rests.
  static PlainRobotMotion plain_motion(const LoadedScene& loaded) {
    const SceneRobot& robot = loaded.scene.robots.front();
    const Trajectory& trajectory = robot.trajectory;
    PlainRobotMotion plain{robot.model, {}, {}};
    for (const Joint& joint : robot.model.joints()) {
      const auto named =
          std::find(trajectory.joint_names.begin(), trajectory.joint_names.end(), joint.name);
      const auto held = robot.state.find(joint.name);
      if (named != trajectory.joint_names.end()) {
        const auto k = static_cast<std::size_t>(named - trajectory.joint_names.begin());
        plain.from.push_back(trajectory.points.front().positions[k]);
        plain.to.push_back(trajectory.points.back().positions[k]);
      } else {
        plain.from.push_back(held != robot.state.end() ? held->second : default_position(joint));
        plain.to.push_back(plain.from.back());
      }
    }
    return plain;
  }

  [[nodiscard]] static Eigen::Isometry3d place(const std::vector<Eigen::Isometry3d>& links,
                                               const Piece& piece) {
    return piece.link ? links[*piece.link] * piece.X : piece.X;
  }

  template <typename Holds>
  [[nodiscard]] bool any_piece(const BodyPair& pair, const Holds& holds) const {
    for (const Piece& a : pieces_[pair[0]]) {
      for (const Piece& b : pieces_[pair[1]]) {
        if (holds(a, b)) {
          return true;
        }
      }
    }
    return false;
  }

  const RobotScene& scene_;
  PlainRobotMotion plain_;
  std::vector<std::vector<Piece>> pieces_;  // By members.
  std::vector<BodyPair> pairs_;
};

/// A row of the table.
struct Family {
  int problems = 0;
  int starts = 0;
  int contacts = 0;
  int frees = 0;
  int undecided = 0;
  std::array<int, kSteps.size()> missed = {};
  int grazes = 0;         ///< Missed motions in which not even fine samples collide.
  int beyond_limits = 0;  ///< Motions that leave a joint limit.
};

class Campaign {
 public:
  explicit Campaign(fs::path data) : data_(std::move(data)) {}

  void ask(const fs::path& request, Family& family) {
    const LoadedScene loaded = load_scene(read(request), cache_);
    const SceneResult answer = check_scene(loaded, workspace_);
    name_ = request.parent_path().filename().string() + "/" + request.filename().string();
    ++family.problems;
    family.beyond_limits += loaded.limits.empty() ? 0 : 1;
    switch (answer.verdict) {
      case Verdict::free:
        ++family.frees;
        break;
      case Verdict::contact:
        ++family.contacts;
        break;
      case Verdict::contact_at_start:
        ++family.starts;
        break;
      case Verdict::undecided:
        ++family.undecided;
        return;
    }
    hold(answer, SampledScene(loaded, shapes_), family);
  }

  [[nodiscard]] int complaints() const { return complaints_; }

 private:
  [[nodiscard]] Scene read(const fs::path& request) const {
    const std::string name = request.filename().string();
    const fs::path panda = data_ / "robots/moveit_resources_panda_description";
    return read_robot_question(
        {.robot = {.urdf = panda / "urdf/panda.urdf", .package_roots = {data_ / "robots"}},
         .srdf = panda / "srdf/panda.srdf",
         .request = request,
         .environment = {request.parent_path() /
                         ("scene" + name.substr(std::string("request").size()))}});
  }

  void hold(const SceneResult& answer, const SampledScene& sampled, Family& family) {
    const bool free = answer.verdict == Verdict::free;
    bool all_see = true;
    for (std::size_t k = 0; k < kSteps.size(); ++k) {
      const bool seen = sees(answer, sampled, kSteps[k]);
      family.missed.at(k) += !seen && !free ? 1 : 0;
      all_see = all_see && seen;
    }
    if (!free) {
      family.grazes += all_see || sees(answer, sampled, kFineStep) ? 0 : 1;
      const PairAnswer& pair = answer.pairs[*answer.first];
      const double distance = sampled.distance(pair.members, answer.t);
      // Inside of a solid, at the start, surfaces may be apart.
      const bool inside = answer.verdict == Verdict::contact_at_start && sampled.collides(0.0);
      if (!(inside || distance <= pair.margin + pair.tolerance_used + kFclError)) {
        complain(fmt::format("FCL sees {} m at {}", distance, answer.t));
      }
    }
  }

  /// Whether one of the samples collides.
  bool sees(const SceneResult& answer, const SampledScene& sampled, double step) {
    const auto count = static_cast<int>(std::max(1.0, std::ceil(sampled.length() / step)));
    for (int i = 0; i <= count; ++i) {
      const double t = static_cast<double>(i) / count;
      if (sampled.collides(t)) {
        if (answer.verdict == Verdict::free || t < answer.t) {
          complain(fmt::format("FCL sees a contact at {}, before {}", t, answer.t));
        }
        return true;
      }
    }
    return false;
  }

  void complain(const std::string& what) {
    fmt::print(stderr, "{}: {}\n", name_, what);
    ++complaints_;
  }

  fs::path data_;
  ShapeCache cache_;
  ManyBodiesWorkspace workspace_;
  SampledScene::Shapes shapes_;
  std::string name_;
  int complaints_ = 0;
};

void print_row(const std::string& name, const Family& f) {
  fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} |\n", name, f.problems, f.frees, f.starts,
             f.contacts, f.missed[0], f.missed[1], f.undecided);
  std::fflush(stdout);
}

void add(const Family& family, Family& sum) {
  sum.problems += family.problems;
  sum.starts += family.starts;
  sum.contacts += family.contacts;
  sum.frees += family.frees;
  sum.undecided += family.undecided;
  sum.beyond_limits += family.beyond_limits;
  sum.grazes += family.grazes;
  for (std::size_t k = 0; k < kSteps.size(); ++k) {
    sum.missed.at(k) += family.missed.at(k);
  }
}

std::vector<fs::path> requests_in(const fs::path& folder) {
  std::vector<fs::path> requests;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename().string().starts_with("request")) {
      requests.push_back(entry.path());
    }
  }
  std::sort(requests.begin(), requests.end());
  return requests;
}

int run(std::size_t every) {
  Campaign campaign(data_dir());
  fmt::print(
      "| problems | motions | free | in contact at the start | in contact later | of these "
      "missed at 1° | missed at 5° | undecided |\n|---|--:|--:|--:|--:|--:|--:|--:|\n");
  std::set<fs::path> families;
  for (const auto& entry : fs::directory_iterator(data_dir() / "planning_mbm/panda")) {
    families.insert(entry.path());
  }
  Family sum;
  for (const fs::path& folder : families) {
    const std::vector<fs::path> requests = requests_in(folder);
    Family family;
    for (std::size_t k = 0; k < requests.size(); k += every) {
      campaign.ask(requests[k], family);
    }
    print_row(folder.filename().string(), family);
    add(family, sum);
  }
  print_row("all", sum);
  fmt::print(
      "\n{} motions leave a joint limit; of those missed {} collide at no sample of 0.01° "
      "either; {} complaints\n",
      sum.beyond_limits, sum.grazes, campaign.complaints());
  return campaign.complaints() == 0 && sum.problems > 0 ? 0 : 1;
}

}  // namespace
}  // namespace firstcontact::test

int main(int argc, char** argv) {
  if (firstcontact::test::data_dir().empty()) {
    fmt::print(stderr, "planning_motions: needs FIRSTCONTACT_DATA_DIR\n");
    return 77;  // Skipped, as ctest sees it.
  }
  const bool some = argc == 3 && std::string(argv[1]) == "--every";
  if (argc != 1 && !some) {
    fmt::print(stderr, "usage: planning_motions [--every N]\n");
    return 2;
  }
  const int every = some ? std::atoi(argv[2]) : 1;
  return firstcontact::test::run(static_cast<std::size_t>(std::max(1, every)));
}
