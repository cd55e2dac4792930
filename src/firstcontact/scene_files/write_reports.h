/// @file
/// Writes reports on files, and counts of the tested pairs, as JSON.

#pragma once

#include <span>
#include <string>

#include <firstcontact/math/export.h>
#include <firstcontact/scene/pair_counts.h>
#include <firstcontact/text/file_report.h>

namespace firstcontact {

/// Writes reports as an array, as "files" of a result.
[[nodiscard]] FIRSTCONTACT_API std::string write_file_reports(std::span<const FileReport> reports);

/// Writes counts as an object, as "pair_counts" of a result.
[[nodiscard]] FIRSTCONTACT_API std::string write_pair_counts(const PairCounts& counts);

}  // namespace firstcontact
