#include <firstcontact/haptics/detail/contact_reduction.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include <firstcontact/haptics/detail/cone_projection.h>
#include <firstcontact/haptics/detail/row_cone.h>

namespace firstcontact::detail {
namespace {

using Deadline = std::chrono::steady_clock::time_point;
using Row = std::array<double, kMostCoordinates>;

/// [contacts]  Contacts between two looks at the clock.
constexpr std::size_t kBetweenLooks = 8;

/// The unit rows of a contact: that of its normal, and with friction the four edges of its cone.
struct ContactRows {
  Row normal = {};
  std::array<Row, 4> edges = {};
  std::size_t count = 0;  ///< Number of edges: 0 or 4.
};

double product(const Row& a, const Row& b, std::size_t n) {
  double sum = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    sum += a[k] * b[k];
  }
  return sum;
}

Row unit(Row row, std::size_t n) {
  const double length = std::sqrt(product(row, row, n));
  for (std::size_t k = 0; k < n; ++k) {
    row[k] /= length;
  }
  return row;
}

ContactRows rows_of(const HapticContact& contact, const ToolFrames& frames, std::size_t n) {
  const ConeContact cone = cone_contact(contact, frames);
  ContactRows rows;
  rows.normal = unit(cone.rows[0], n);
  if (cone.friction == 0.0) {
    return rows;
  }
  for (std::size_t edge = 0; edge < 4; ++edge) {
    const double mu = edge % 2 == 0 ? cone.friction : -cone.friction;
    Row row = cone.rows[0];
    for (std::size_t k = 0; k < n; ++k) {
      row[k] += mu * cone.rows[1 + edge / 2][k];
    }
    rows.edges[edge] = unit(row, n);
  }
  rows.count = 4;
  return rows;
}

/// The contacts that are kept with one angle.
class Reduction {
 public:
  Reduction(std::size_t coordinates, double angle)
      : n_(coordinates),
        cosine_(std::cos(kShare * angle)),
        sine_(std::sin(kShare * angle)),
        normals_(coordinates),
        edges_(coordinates) {}

  /// Whether kept normals span the normal, and kept edges the edges. So friction does not keep a
  /// contact whose normal is spanned.
  [[nodiscard]] bool spans(const ContactRows& contact) {
    if (!normals_.is_near(contact.normal, sine_)) {
      return false;
    }
    for (std::size_t k = 0; k < contact.count; ++k) {
      if (!edges_.is_near(contact.edges[k], sine_)) {
        return false;
      }
    }
    return true;
  }

  /// Whether each row is near that of one seen contact.
  [[nodiscard]] bool is_like_another(const ContactRows& contact) const {
    return std::ranges::any_of(seen_, [&](const ContactRows* other) {
      if (other->count != contact.count || !are_near(other->normal, contact.normal)) {
        return false;
      }
      for (std::size_t k = 0; k < contact.count; ++k) {
        if (!are_near(other->edges[k], contact.edges[k])) {
          return false;
        }
      }
      return true;
    });
  }

  /// Adds a contact to those that were seen; `contact` outlives this.
  void see(const ContactRows& contact) { seen_.push_back(&contact); }

  void keep(const ContactRows& contact) {
    normals_.add(contact.normal);
    for (std::size_t k = 0; k < contact.count; ++k) {
      edges_.add(contact.edges[k]);
    }
  }

 private:
  /// [-]  Fraction of the angle for each of two steps: from a row to a seen one, and from that to
  /// the cone. Both together stay below the angle, rounding included.
  static constexpr double kShare = 0.499;

  [[nodiscard]] bool are_near(const Row& a, const Row& b) const {
    return product(a, b, n_) >= cosine_;
  }

  std::size_t n_;
  double cosine_;
  double sine_;
  RowCone normals_;
  RowCone edges_;
  std::vector<const ContactRows*> seen_;
};

/// The outcome of a reduction with one angle.
enum class Outcome { done, too_many, late };

/// Finds the contacts that are kept with one angle.
Outcome keep_within(const std::vector<ContactRows>& rows, const std::vector<std::size_t>& order,
                    std::size_t coordinates, double angle, std::size_t most,
                    const std::optional<Deadline>& deadline, std::vector<std::size_t>& kept) {
  Reduction reduction(coordinates, angle);
  kept.clear();
  std::size_t looked = 0;
  for (const std::size_t c : order) {
    if (reduction.is_like_another(rows[c])) {
      continue;
    }
    if (deadline && looked++ % kBetweenLooks == 0 &&
        std::chrono::steady_clock::now() >= *deadline) {
      return Outcome::late;
    }
    reduction.see(rows[c]);
    if (reduction.spans(rows[c])) {
      continue;
    }
    if (kept.size() == most) {
      return Outcome::too_many;
    }
    kept.push_back(c);
    reduction.keep(rows[c]);
  }
  return Outcome::done;
}

/// Orders contacts so that each one is far from those before it. The outermost come first, and
/// span those between. The first one is the nearest; behind the first `spread` the order is that of
/// gaps.
std::vector<std::size_t> spread_order(std::span<const HapticContact> contacts,
                                      const std::vector<ContactRows>& rows, std::size_t coordinates,
                                      std::size_t spread) {
  std::vector<std::size_t> order(contacts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t c) { return contacts[c].gap; });
  std::vector<double> nearest(contacts.size(), -2.0);  // Greatest cosine to one before.
  for (std::size_t k = 0; k + 1 < order.size() && k < spread; ++k) {
    const Row& last = rows[order[k]].normal;
    std::size_t farthest = k + 1;
    for (std::size_t i = k + 1; i < order.size(); ++i) {
      double& cosine = nearest[order[i]];
      cosine = std::max(cosine, product(last, rows[order[i]].normal, coordinates));
      farthest = cosine < nearest[order[farthest]] ? i : farthest;
    }
    std::rotate(order.begin() + static_cast<std::ptrdiff_t>(k + 1),
                order.begin() + static_cast<std::ptrdiff_t>(farthest),
                order.begin() + static_cast<std::ptrdiff_t>(farthest + 1));
  }
  return order;
}

}  // namespace

ReducedContacts reduce_contacts(
    std::span<const HapticContact> contacts, const ToolFrames& frames, std::size_t tools,
    double angle, std::size_t most,
    const std::optional<std::chrono::steady_clock::time_point>& deadline) {
  const std::size_t coordinates = frames.coordinates(tools);
  std::vector<ContactRows> rows;
  rows.reserve(contacts.size());
  for (const HapticContact& contact : contacts) {
    rows.push_back(rows_of(contact, frames, coordinates));
  }
  const std::vector<std::size_t> order = spread_order(contacts, rows, coordinates, most);
  ReducedContacts reduced{.kept = {}, .angle = angle};
  Outcome outcome = Outcome::too_many;
  while (outcome == Outcome::too_many && reduced.angle < std::numbers::pi / 2.0) {
    outcome = keep_within(rows, order, coordinates, reduced.angle, most, deadline, reduced.kept);
    reduced.angle *= outcome == Outcome::too_many ? 2.0 : 1.0;
  }
  if (outcome != Outcome::done) {  // Nothing is claimed: the most different ones are kept.
    reduced.angle = std::numbers::pi;
    reduced.kept.assign(order.begin(),
                        order.begin() + static_cast<std::ptrdiff_t>(std::min(most, order.size())));
  }
  std::ranges::sort(reduced.kept);
  if (reduced.kept.size() == contacts.size()) {
    reduced.angle = 0.0;
  }
  return reduced;
}

}  // namespace firstcontact::detail
