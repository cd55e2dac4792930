/// @file
/// The small projection of the force loop: the displacement that contacts with friction permit.

#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <firstcontact/haptics/contact_set.h>

namespace firstcontact::detail {

/// The coordinates of all tools: for each the translation of its centre, then its rotation vector
/// times the length by which the metric weighs turning. Those of joints follow, each times its
/// length.
inline constexpr std::size_t kMostCoordinates = 6 * kMostTools + kMostHapticJoints;
using Coordinates = std::array<double, kMostCoordinates>;

/// A contact in these coordinates. Its displacement is that of the tool relative to the other
/// surface, along the normal and two tangents: u = rows x - shift.
struct ConeContact {
  std::array<Coordinates, 3> rows = {};  ///< Normal, then two tangents.
  std::array<double, 3> shift = {};      ///< [m]  Displacement of the other surface.
  double way = 0.0;       ///< [m]  Distance by which the surfaces may come nearer: u_n >= -way.
  double friction = 0.0;  ///< [-]
};

/// The answer of a projection.
struct ConeProjectionResult {
  Coordinates x = {};  ///< [m]  The displacement that contacts permit.
  /// [m]  x less the free displacement, caused by contacts. Exactly 0 where none presses.
  Coordinates force = {};
  int pressing = 0;  ///< Number of contacts with an impulse.
  int pivots = 0;    ///< Number of changes of the active set.
  /// False where the pivots were spent, or the contacts contradict each other.
  bool is_solved = false;
};

/// Projects a displacement on contacts with Coulomb friction, in bounded work and fixed memory.
///
/// The law is that of project_on_contacts(): impulses r in Coulomb's round cones, u' = u + way n,
/// u' + mu |u_t| n in the dual cone, orthogonal to r (De Saxce, Feng, "The bipotential method",
/// Mathematical and Computer Modelling 28 (1998)).
///
/// Method. For a given s in place of mu |u_t| it is the projection on a convex set, u_n + way + s
/// >= mu d . u_t for all unit d. A dual active set method adds the half space that is violated
/// most: d is the direction in which the contact slides. (Goldfarb, Idnani, "A numerically stable
/// dual method for solving strictly convex quadratic programs", Mathematical Programming 27
/// (1983).) So the cone is round, and an impulse lies in it even where the work ends early. s is
/// then found by Anderson's acceleration over one step. The active set and s are kept for the next
/// projection.
///
/// After the construction nothing is allocated.
class ConeProjection {
 public:
  /// Reserves the memory.
  ///
  /// @param coordinates  6 or 12, and one for each joint
  /// @param capacity     most contacts
  ConeProjection(std::size_t coordinates, std::size_t capacity);

  /// Forgets all contacts and the active set.
  void clear() noexcept;

  /// Adds a contact. A contact beyond the capacity is left out.
  void add(const ConeContact& contact) noexcept;

  /// Moves the other surface of a contact.
  void set_shift(std::size_t contact, const std::array<double, 3>& shift) noexcept {
    contacts_[contact].shift = shift;
  }

  [[nodiscard]] std::size_t size() const noexcept { return contacts_.size(); }

  /// Projects a free displacement.
  ///
  /// @param tolerance    [m]  half spaces may be violated by this much
  /// @param most_pivots  over all rounds
  [[nodiscard]] ConeProjectionResult project(const Coordinates& x_free, double tolerance,
                                             int most_pivots) noexcept;

  /// Whether a contact that moves some coordinates presses, or is violated by a free displacement.
  ///
  /// @param first, count  the coordinates
  [[nodiscard]] bool presses_on(std::size_t first, std::size_t count, const Coordinates& x_free,
                                double tolerance) const noexcept;

  /// [m]  The impulse of a contact in the last projection, times the inverse metric: along the
  /// normal, then the tangents.
  [[nodiscard]] std::array<double, 3> impulse(std::size_t contact) const noexcept;

 private:
  /// An active half space: row . x >= least.
  struct Cut {
    std::size_t contact = 0;
    std::array<double, 2> direction = {};
    Coordinates row = {};
    double least = 0.0;
    double impulse = 0.0;
  };
  /// The half space that is violated most.
  struct Violated {
    std::size_t contact = 0;
    std::array<double, 2> direction = {};
    double by = 0.0;  // [m]
  };

  [[nodiscard]] double dot(const Coordinates& a, const Coordinates& b) const noexcept;
  [[nodiscard]] std::array<double, 3> displacement(const ConeContact& contact,
                                                   const Coordinates& x) const noexcept;
  void set_least(Cut& cut) const noexcept;
  [[nodiscard]] Cut make_cut(const Violated& violated) const noexcept;
  [[nodiscard]] Violated most_violated(const Coordinates& x) const noexcept;
  [[nodiscard]] bool factorise() noexcept;
  void solve_active(std::array<double, kMostCoordinates>& b) const noexcept;
  void remove(std::size_t k) noexcept;
  void restart(const Coordinates& x_free) noexcept;
  [[nodiscard]] bool add_cut(Cut cut, int most_pivots) noexcept;
  [[nodiscard]] bool satisfy_all(double tolerance, int most_pivots) noexcept;
  [[nodiscard]] double renew_slacks() noexcept;

  std::size_t n_;
  std::size_t capacity_;
  std::vector<ConeContact> contacts_;
  std::vector<double> slack_;       // [m]  s of each contact.
  std::vector<double> last_slack_;  // [m]  s of the round before.
  std::vector<double> last_error_;  // [m]  mu |u_t| - s of the round before.
  std::vector<double> error_;       // [m]
  bool has_last_ = false;
  std::array<Cut, kMostCoordinates> active_ = {};
  std::size_t active_count_ = 0;
  std::array<std::array<double, kMostCoordinates>, kMostCoordinates> factor_ = {};  // Lower.
  std::size_t factored_ = 0;  // Rows of the factor that belong to the active cuts.
  Coordinates x_ = {};
  int pivots_ = 0;
};

}  // namespace firstcontact::detail
