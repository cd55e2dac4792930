#include <algorithm>
#include <cstddef>
#include <deque>
#include <unordered_map>
#include <vector>

#include <firstcontact/dynamics/detail/contact_rows.h>

namespace firstcontact::detail {
namespace {

/// Contacts that wait to be solved, each once; first come, first served.
class WaitingContacts {
 public:
  explicit WaitingContacts(std::size_t count) : waits_(count, false) {}

  [[nodiscard]] bool empty() const { return queue_.empty(); }
  void add(std::size_t k) {
    if (!waits_[k]) {
      waits_[k] = true;
      queue_.push_back(k);
    }
  }
  std::size_t take() {
    const std::size_t k = queue_.front();
    queue_.pop_front();
    waits_[k] = false;
    return k;
  }

 private:
  std::vector<bool> waits_;
  std::deque<std::size_t> queue_;
};

}  // namespace

void project_around(const ContactRows& rows, const std::vector<std::size_t>& changed,
                    const ProjectionOptions& options, Projection& projection) {
  auto& [V, impulses, residual, iterations] = projection;
  const std::size_t count = rows.contacts.size();
  std::unordered_map<Eigen::Index, std::vector<std::size_t>> contacts_of;  // A body's velocities.
  for (std::size_t k = 0; k < count; ++k) {
    for (const RowSide& side : rows.contacts[k].sides) {
      contacts_of[side.at].push_back(k);
    }
  }
  WaitingContacts waiting(count);
  std::ranges::for_each(changed, [&](std::size_t k) { waiting.add(k); });
  const std::size_t most = static_cast<std::size_t>(options.sweeps) * count;
  for (std::size_t solved = 0; !waiting.empty() && solved < most; ++solved) {
    const std::size_t k = waiting.take();
    const ContactRow& row = rows.contacts[k];
    if (!(solve_alone(row, impulses.contacts[k], V) > options.tolerance)) {
      continue;
    }
    for (const RowSide& side : row.sides) {
      if (side.response.isZero(0.0)) {
        continue;  // Nothing moves it.
      }
      for (const std::size_t other : contacts_of.at(side.at)) {
        if (other != k) {
          waiting.add(other);
        }
      }
    }
  }
  residual = greatest_residual(rows, impulses, V);
}

}  // namespace firstcontact::detail
