/// @file
/// Scratch memory of a query.

#pragma once

#include <memory>

#include <firstcontact/math/export.h>

namespace firstcontact {

namespace detail {
struct WorkspaceData;
}

/// Scratch memory that queries reuse, so that a warm query allocates nothing.
///
/// Each thread needs its own. It carries no state from one query to the next.
class FIRSTCONTACT_API Workspace {
 public:
  Workspace();
  ~Workspace();
  Workspace(Workspace&&) noexcept;
  Workspace& operator=(Workspace&&) noexcept;

  [[nodiscard]] detail::WorkspaceData& data() { return *data_; }

 private:
  std::unique_ptr<detail::WorkspaceData> data_;
};

}  // namespace firstcontact
