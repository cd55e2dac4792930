#include <deque>
#include <unordered_map>
#include <vector>

#include <firstcontact/dynamics/detail/contact_rows.h>

namespace firstcontact::detail {
namespace {

/// Contacts that wait to be solved, first come, first served.
class Neighbourhood {
 public:
  Neighbourhood(const ContactRows& rows, const ProjectionOptions& options, Projection& projection)
      : rows_(rows),
        tolerance_(options.tolerance),
        most_(static_cast<std::size_t>(options.sweeps) * rows.contacts.size()),
        projection_(projection),
        waits_(rows.contacts.size(), false) {
    for (std::size_t k = 0; k < rows.contacts.size(); ++k) {
      for (const RowSide& side : rows.contacts[k].sides) {
        contacts_of_[side.at].push_back(k);
      }
    }
  }

  void project(const std::vector<std::size_t>& changed) {
    for (const std::size_t k : changed) {
      wait(k);
    }
    for (std::size_t solved = 0; !queue_.empty() && solved < most_; ++solved) {
      const std::size_t k = queue_.front();
      queue_.pop_front();
      waits_[k] = false;
      const double change =
          solve_alone(rows_.contacts[k], projection_.impulses.contacts[k], projection_.velocities);
      if (change > tolerance_) {
        for (const RowSide& side : rows_.contacts[k].sides) {
          if (!side.response.isZero(0.0)) {
            for (const std::size_t other : contacts_of_.at(side.at)) {
              if (other != k) {
                wait(other);
              }
            }
          }
        }
      }
    }
  }

 private:
  void wait(std::size_t k) {
    if (!waits_[k]) {
      waits_[k] = true;
      queue_.push_back(k);
    }
  }

  const ContactRows& rows_;
  double tolerance_;
  std::size_t most_;
  Projection& projection_;
  std::vector<bool> waits_;
  std::deque<std::size_t> queue_;
  std::unordered_map<Eigen::Index, std::vector<std::size_t>> contacts_of_;
};

}  // namespace

void project_around(const ContactRows& rows, const std::vector<std::size_t>& changed,
                    const ProjectionOptions& options, Projection& projection) {
  Neighbourhood(rows, options, projection).project(changed);
  projection.residual = greatest_residual(rows, projection.impulses, projection.velocities);
}

}  // namespace firstcontact::detail
