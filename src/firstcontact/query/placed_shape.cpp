#include <firstcontact/query/placed_shape.h>

#include <firstcontact/geometry/hierarchy.h>

namespace firstcontact {

PlacedShape::PlacedShape(const Shape& shape, const Pose& X_WS)
    : shape_(&shape),
      pose_(X_WS),
      motion_(Motion::fixed(X_WS)),
      path_(motion_.path(0, shape.hierarchy().centre)) {}

}  // namespace firstcontact
