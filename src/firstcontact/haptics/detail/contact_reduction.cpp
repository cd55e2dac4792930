#include <firstcontact/haptics/detail/contact_reduction.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include <firstcontact/haptics/detail/cone_projection.h>

namespace firstcontact::detail {
namespace {

/// [pivots]  Most pivots of one projection on a cone.
constexpr int kPivotsOfRow = 60;

/// [-]  Tolerance of the projection of a row of unit length.
constexpr double kToleranceOfRow = 1e-12;

/// The unit rows of a contact: that of its normal, and with friction the four edges of its cone.
struct ContactRows {
  Coordinates normal = {};
  std::array<Coordinates, 4> edges = {};
  std::size_t count = 0;  ///< Number of edges: 0 or 4.
};

double product(const Coordinates& a, const Coordinates& b, std::size_t n) {
  return std::inner_product(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(n), b.begin(), 0.0);
}

Coordinates unit(Coordinates row, std::size_t n) {
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
    Coordinates row = cone.rows[0];
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
  Reduction(std::size_t coordinates, double angle, std::size_t most)
      : n_(coordinates),
        cosine_(std::cos(kShare * angle)),
        sine_(std::sin(kShare * angle)),
        normals_(coordinates, most),
        edges_(coordinates, 4 * most) {}

  /// Whether kept normals span the normal, and kept edges the edges. So friction does not keep a
  /// contact whose normal is spanned.
  [[nodiscard]] bool spans(const ContactRows& contact) {
    if (!spans(normals_, contact.normal)) {
      return false;
    }
    for (std::size_t k = 0; k < contact.count; ++k) {
      if (!spans(edges_, contact.edges[k])) {
        return false;
      }
    }
    return true;
  }

  /// Whether each row is near that of one seen contact.
  [[nodiscard]] bool is_like_another(const ContactRows& contact) const {
    return std::ranges::any_of(seen_, [&](const ContactRows& other) {
      if (other.count != contact.count || !are_near(other.normal, contact.normal)) {
        return false;
      }
      for (std::size_t k = 0; k < contact.count; ++k) {
        if (!are_near(other.edges[k], contact.edges[k])) {
          return false;
        }
      }
      return true;
    });
  }

  void see(const ContactRows& contact) { seen_.push_back(contact); }

  void keep(const ContactRows& contact) {
    normals_.add({.rows = {contact.normal, {}, {}}});
    for (std::size_t k = 0; k < contact.count; ++k) {
      edges_.add({.rows = {contact.edges[k], {}, {}}});
    }
  }

 private:
  /// [-]  Fraction of the angle for each of two steps: from a row to a seen one, and from that to
  /// the cone. Both together stay below the angle, rounding included.
  static constexpr double kShare = 0.499;

  [[nodiscard]] bool are_near(const Coordinates& a, const Coordinates& b) const {
    return product(a, b, n_) >= cosine_;
  }

  bool spans(ConeProjection& cone, const Coordinates& row) {
    Coordinates against{};
    for (std::size_t k = 0; k < n_; ++k) {
      against[k] = -row[k];
    }
    const ConeProjectionResult rest = cone.project(against, kToleranceOfRow, kPivotsOfRow);
    return rest.is_solved && std::sqrt(product(rest.x, rest.x, n_)) <= sine_;
  }

  std::size_t n_;
  double cosine_;
  double sine_;
  ConeProjection normals_;
  ConeProjection edges_;
  std::vector<ContactRows> seen_;
};

/// Finds the contacts that are kept with one angle; none where they are more than permitted.
std::optional<std::vector<std::size_t>> kept_within(const std::vector<ContactRows>& rows,
                                                    const std::vector<std::size_t>& order,
                                                    std::size_t coordinates, double angle,
                                                    std::size_t most) {
  Reduction reduction(coordinates, angle, most);
  std::vector<std::size_t> kept;
  for (const std::size_t c : order) {
    if (reduction.is_like_another(rows[c])) {
      continue;
    }
    reduction.see(rows[c]);
    if (reduction.spans(rows[c])) {
      continue;
    }
    if (kept.size() == most) {
      return {};
    }
    kept.push_back(c);
    reduction.keep(rows[c]);
  }
  return kept;
}

}  // namespace

ReducedContacts reduce_contacts(std::span<const HapticContact> contacts, const ToolFrames& frames,
                                std::size_t tools, double angle, std::size_t most) {
  const std::size_t coordinates = frames.coordinates(tools);
  std::vector<ContactRows> rows;
  rows.reserve(contacts.size());
  for (const HapticContact& contact : contacts) {
    rows.push_back(rows_of(contact, frames, coordinates));
  }
  std::vector<std::size_t> order(contacts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t c) { return contacts[c].gap; });
  ReducedContacts reduced{.kept = {}, .angle = angle};
  while (true) {
    if (auto kept = kept_within(rows, order, coordinates, reduced.angle, most)) {
      reduced.kept = std::move(*kept);
      break;
    }
    reduced.angle *= 2.0;
    if (reduced.angle >= std::numbers::pi / 2.0) {  // Nothing is claimed: the nearest are kept.
      reduced.angle = std::numbers::pi;
      reduced.kept.assign(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(most));
      break;
    }
  }
  std::ranges::sort(reduced.kept);
  if (reduced.kept.size() == contacts.size()) {
    reduced.angle = 0.0;
  }
  return reduced;
}

}  // namespace firstcontact::detail
