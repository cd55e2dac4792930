#include <firstcontact/model_files/detail/dae_budget.h>

#include <algorithm>

namespace firstcontact::detail {

DaeBudget::DaeBudget(std::size_t bytes)
    : left_(std::max<std::uint64_t>(
          bytes, std::min<std::uint64_t>(100'000'000, 1'000'000 + std::uint64_t{1000} * bytes))) {}

void DaeBudget::spend(const DaeDocument& document, const XmlElement& where, std::uint64_t work) {
  if (work > left_) {
    document.fail(where,
                  "the instances of the scene unfold to more than is read from a file of its size "
                  "(a million and a thousand for each byte, a hundred million at most)");
  }
  left_ -= work;
}

}  // namespace firstcontact::detail
