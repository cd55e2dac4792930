/// @file
/// Writes what became of files, and which pairs were looked at, as JSON.

#pragma once

#include <span>
#include <string>

#include <firstcontact/math/export.h>
#include <firstcontact/scene/pair_counts.h>
#include <firstcontact/text/file_report.h>

namespace firstcontact {

/// An array, as "files" of a result.
[[nodiscard]] FIRSTCONTACT_API std::string write_file_reports(std::span<const FileReport> reports);

/// An object, as "pair_counts" of a result.
[[nodiscard]] FIRSTCONTACT_API std::string write_pair_counts(const PairCounts& counts);

}  // namespace firstcontact
