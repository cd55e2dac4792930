#include <firstcontact/many_bodies/body_set.h>

#include <utility>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/math/float_environment.h>

namespace firstcontact {

std::vector<ConstantRatePath> BodySet::centre_path_of(const Shape& shape, const Motion& X_WS) {
  const FloatEnvironmentGuard guard;
  std::vector<ConstantRatePath> path;
  for (std::size_t piece = 0; piece + 1 < X_WS.breaks().size(); ++piece) {
    path.push_back(X_WS.path(piece, shape.hierarchy().centre));
  }
  return path;
}

std::size_t BodySet::add(Shape shape, Motion X_WS) {
  std::vector<ConstantRatePath> path = centre_path_of(shape, X_WS);
  bodies_.push_back({std::move(shape), std::move(X_WS), std::move(path)});
  return bodies_.size() - 1;
}

void BodySet::set_shape(std::size_t body, Shape shape) {
  Body& changed = bodies_.at(body);
  changed.centre_path = centre_path_of(shape, changed.X_WS);
  changed.shape = std::move(shape);
}

void BodySet::set_motion(std::size_t body, Motion X_WS) {
  Body& changed = bodies_.at(body);
  changed.centre_path = centre_path_of(changed.shape, X_WS);
  changed.X_WS = std::move(X_WS);
}

}  // namespace firstcontact
