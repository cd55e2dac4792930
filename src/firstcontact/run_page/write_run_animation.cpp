#include <firstcontact/run_page/write_run_animation.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <firstcontact/scene/links_as_bodies.h>
#include <firstcontact/scene/loaded_scene.h>

namespace firstcontact {
namespace {

using detail::GlbKey;
using detail::GlbLook;

void add_key(std::vector<GlbKey>& keys, double time, const Eigen::Vector3d& place,
             const Eigen::Quaterniond& R_WB) {
  GlbKey key{static_cast<float>(time), place, R_WB.normalized()};
  if (!keys.empty() && keys.back().R_WB.dot(key.R_WB) < 0.0) {
    key.R_WB.coeffs() *= -1.0;
  }
  // Times of keys increase strictly. Pieces may be shorter than single precision resolves.
  if (!keys.empty() && !(key.time > keys.back().time)) {
    key.time = keys.back().time;
    keys.back() = key;
  } else {
    keys.push_back(key);
  }
}

}  // namespace

RunAnimation::RunAnimation(const RunHeader& header)
    : header_(header), courses_(header.centres_of_mass.size()) {}

Eigen::Vector3d RunAnimation::centre(std::size_t body, const Pose& X_WB) const {
  return X_WB.position + X_WB.rotation.normalized() * header_.centres_of_mass.at(body);
}

void RunAnimation::add_piece(std::size_t body, double from, const RunPiece& piece, double seconds) {
  const double angle = piece.rotation_vector.norm();
  const Eigen::Vector3d axis =
      angle > 0.0 ? Eigen::Vector3d(piece.rotation_vector / angle) : Eigen::Vector3d::UnitX();
  const double parts = std::max(1.0, std::ceil(angle / (0.5 * std::numbers::pi)));
  for (double k = 0.0; k < parts; k += 1.0) {
    const double share = k / parts;
    add_key(courses_.at(body).keys, from + share * seconds,
            centre(body, piece.X_WB) + share * piece.translation,
            Eigen::AngleAxisd(share * angle, axis) * piece.X_WB.rotation.normalized());
  }
}

void RunAnimation::add(const RunStep& step) {
  for (const RunBody& moved : step.bodies) {
    Course& course = courses_.at(moved.body);
    double from = time_;
    if (!course.keys.empty() && course.end < from) {
      // The body is not in the last steps, as it stayed in place.
      add_key(course.keys, course.end, centre(moved.body, course.X_WB), course.X_WB.rotation);
    }
    for (const RunPiece& piece : moved.pieces) {
      add_piece(moved.body, from, piece, time_ + piece.to - from);
      from = time_ + piece.to;
    }
    course.end = from;
    course.X_WB = moved.X_WB;
  }
  time_ = step.time;
}

std::string RunAnimation::write(const LoadedScene& loaded) const {
  if (!(time_ > 0.0)) {
    throw std::invalid_argument("expected a run of some time: there is nothing to play");
  }
  const LoadedScene linked = links_as_bodies(loaded).loaded;
  detail::GlbScene scene;
  for (std::size_t body = 0; body < courses_.size(); ++body) {
    Course course = courses_[body];
    const bool is_free = header_.masses.at(body) > 0.0;
    const GlbLook look = is_free               ? GlbLook::free
                         : course.keys.empty() ? GlbLook::resting
                                               : GlbLook::scripted;
    if (course.keys.empty()) {
      course.X_WB = linked.bodies.motion(body).pose(0.0);
    }
    add_key(course.keys, course.end, centre(body, course.X_WB), course.X_WB.rotation);
    scene.add({linked.scene.bodies[body].name, look, header_.centres_of_mass[body],
               std::move(course.keys)},
              shape_of_body(linked, body));
  }
  const Eigen::Vector3d gravity = header_.scene.simulation.value().gravity;
  return scene.write(gravity.norm() > 0.0 ? Eigen::Vector3d(-gravity) : Eigen::Vector3d::UnitZ());
}

}  // namespace firstcontact
