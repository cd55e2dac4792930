#include <firstcontact/query/workspace.h>

#include <firstcontact/query/detail/workspace_data.h>

namespace firstcontact {

Workspace::Workspace() : data_(std::make_unique<detail::WorkspaceData>()) {}
Workspace::~Workspace() = default;
Workspace::Workspace(Workspace&&) noexcept = default;
Workspace& Workspace::operator=(Workspace&&) noexcept = default;

}  // namespace firstcontact
