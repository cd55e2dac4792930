// A cloth of a thousand vertices that drapes and folds over the bunny while it turns.

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/geometry/deforming_body.h>
#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/mesh_files/read_mesh.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/query/first_contact.h>

#include "query/sheet.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;
using test::sheet;

// Held to the distance at single times, which knows nothing of motion: also where it folds over.
TEST(Deforming, ClothMeetsAMovingBunny) {
  const Shape bunny(read_mesh(std::filesystem::path(FIRSTCONTACT_SOURCE_DIR) /
                              "data/stanford/stanford-bunny.obj"));
  const Vector3d middle = bunny.hierarchy().centre;
  const double size = bunny.hierarchy().radius;
  Mesh cloth = sheet(32, [](double, double) { return 1.3; });
  Points drape;
  Points fold;
  for (Vector3d& v : cloth.vertices) {
    drape.emplace_back(middle +
                       size * Vector3d(v.x(), v.y(), 0.4 - 0.3 * v.head<2>().squaredNorm()));
    fold.emplace_back(middle + size * Vector3d(-v.x(), v.y(), v.x() < 0.0 ? 0.1 : 1.3));
    v = middle + size * v;
  }
  const Motion turning = Motion::constant_velocity(Pose{}, {0.1 * size, 0, 0}, {0.3, 0.1, 2.0});
  for (const Points& to : {drape, fold}) {
    const DeformingBody body = move_vertices(Shape(cloth, 0.001 * size), to);
    Workspace workspace;
    FirstContactOptions options;
    options.tolerance = 1e-7;
    const FirstContactResult result =
        first_contact({body.shape, body.X_WS}, {bunny, turning}, workspace, options);
    ASSERT_EQ(result.verdict, Verdict::contact);
    EXPECT_FALSE(result.contacts.empty());
    const auto at = [&](double t) {
      return distance({body.shape, body.X_WS}, {bunny, turning}, t, workspace);
    };
    for (int k = 0; k < 40; ++k) {
      EXPECT_GT(at(result.t * k / 40.0).lower_bound, 0.0) << k;
    }
    EXPECT_LE(at(result.t).distance, 1e-7);
    EXPECT_LT(at(std::min(1.0, result.t + 1e-3)).distance, 1e-7);
  }
}

}  // namespace
}  // namespace firstcontact
