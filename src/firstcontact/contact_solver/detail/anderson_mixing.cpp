#include <firstcontact/contact_solver/detail/anderson_mixing.h>

#include <vector>

namespace firstcontact::detail {
namespace {

using Eigen::VectorXd;

/// [-]  A difference of changes is dropped if the part across newer ones is below this fraction.
constexpr double kDependent = 1e-10;

}  // namespace

/// The newest differences come first: older ones are from farther away, where the map may differ.
/// Each is made orthogonal to those before it.
VectorXd AndersonMixing::next(const VectorXd& x, const VectorXd& change) {
  VectorXd guess = x + change;
  VectorXd left = change;
  std::vector<VectorXd> directions;  // Orthogonal unit differences of changes...
  std::vector<VectorXd> ways;        // ... and the differences of guess + change along with them.
  for (std::size_t k = guesses_.size(); k-- > 0;) {
    VectorXd direction = change - changes_[k];
    VectorXd way = x - guesses_[k] + direction;
    const double length = direction.norm();
    for (std::size_t j = 0; j < directions.size(); ++j) {
      const double along = directions[j].dot(direction);
      direction -= along * directions[j];
      way -= along * ways[j];
    }
    const double rest = direction.norm();
    if (!(rest > kDependent * length)) {
      continue;
    }
    directions.push_back(direction / rest);
    ways.push_back(way / rest);
    const double share = directions.back().dot(left);
    left -= share * directions.back();
    guess -= share * ways.back();
  }
  guesses_.push_back(x);
  changes_.push_back(change);
  if (guesses_.size() > kKept) {
    guesses_.pop_front();
    changes_.pop_front();
  }
  return guess;
}

}  // namespace firstcontact::detail
