/// @file
/// Passes the features of the oracle's soups to the elementary tests.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/motion/motion.h>
#include <firstcontact/narrowphase/edge_edge_contact.h>
#include <firstcontact/narrowphase/vertex_face_contact.h>

#include "support/library_case.h"

namespace firstcontact::oracle {

/// Elementary motions of two motions over the step: one for each common piece, in order.
///
/// Each stands also with the bodies swapped.
class ElementaryPieces {
 public:
  /// @param center_A, center_B  body points that the features' coordinates start from
  ElementaryPieces(const Motion& A, const Motion& B, const Eigen::Vector3d& center_A,
                   const Eigen::Vector3d& center_B) {
    for (std::size_t a = 0; a + 1 < A.breaks().size(); ++a) {
      for (std::size_t b = 0; b + 1 < B.breaks().size(); ++b) {
        if (A.breaks()[a] < B.breaks()[b + 1] && B.breaks()[b] < A.breaks()[a + 1]) {
          const ConstantRatePath path_A = A.path(a, center_A);
          const ConstantRatePath path_B = B.path(b, center_B);
          AB_.emplace_back(RelativeMotion(path_A, path_B, 0.0));
          BA_.emplace_back(RelativeMotion(path_B, path_A, 0.0));
        }
      }
    }
  }

  /// Returns the first answer that is not `free`; `test` computes that of one piece.
  template <class Test>
  [[nodiscard]] ElementaryContact first(bool swapped, const Test& test) const {
    ElementaryContact answer;
    int steps = 0;
    for (const ElementaryMotion& motion : swapped ? BA_ : AB_) {
      answer = test(motion);
      steps += answer.steps;
      if (answer.verdict != ElementaryVerdict::free) {
        break;
      }
    }
    answer.steps = steps;
    return answer;
  }

 private:
  std::vector<ElementaryMotion> AB_;
  std::vector<ElementaryMotion> BA_;
};

inline Eigen::Vector3d corner(const MovingSoup& soup, std::size_t triangle, std::size_t k) {
  const Vector3<double>& v = soup.vertices[soup.triangles[triangle][k % 3]];
  const Vector3<double>& center = soup.vertices[0];
  return {v.x - center.x, v.y - center.y, v.z - center.z};
}

/// Tests all pairs of features of two soups without radius, and passes each answer to `use`.
template <class Use>
void for_each_feature_pair(const MovingSoup& A, const MovingSoup& B, const Use& use) {
  const auto center = [](const MovingSoup& soup) {
    return Eigen::Vector3d(soup.vertices[0].x, soup.vertices[0].y, soup.vertices[0].z);
  };
  const ElementaryPieces pieces(to_motion(A.motion), to_motion(B.motion), center(A), center(B));
  const auto vertices_on_faces = [&](const MovingSoup& faces, const MovingSoup& vertices,
                                     bool swapped, std::size_t a, std::size_t b) {
    const Triangle face = {corner(faces, a, 0), corner(faces, a, 1), corner(faces, a, 2)};
    for (std::size_t k = 0; k < 3; ++k) {
      use(pieces.first(swapped, [&](const ElementaryMotion& motion) {
        return vertex_face_contact(motion, face, corner(vertices, b, k));
      }));
    }
  };
  for (std::size_t a = 0; a < A.triangles.size(); ++a) {
    for (std::size_t b = 0; b < B.triangles.size(); ++b) {
      vertices_on_faces(A, B, false, a, b);
      vertices_on_faces(B, A, true, b, a);
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
          use(pieces.first(false, [&](const ElementaryMotion& motion) {
            return edge_edge_contact(motion, {corner(A, a, i), corner(A, a, i + 1)},
                                     {corner(B, b, j), corner(B, b, j + 1)});
          }));
        }
      }
    }
  }
}

}  // namespace firstcontact::oracle
