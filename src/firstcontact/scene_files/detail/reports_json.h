/// @file
/// Reports of files and counts of pairs as JSON trees.

#pragma once

#include <span>

#include <firstcontact/scene/pair_counts.h>
#include <firstcontact/text/file_report.h>
#include <firstcontact/text/json_tree.h>

namespace firstcontact::detail {

/// Makes a JSON array of the reports on files.
[[nodiscard]] JsonValue reports_json(std::span<const FileReport> reports);

/// Makes a JSON object of the counts of pairs.
[[nodiscard]] JsonValue pair_counts_json(const PairCounts& counts);

}  // namespace firstcontact::detail
