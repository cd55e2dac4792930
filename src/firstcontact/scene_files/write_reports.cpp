#include <firstcontact/scene_files/write_reports.h>

#include <utility>

#include <firstcontact/scene_files/detail/reports_json.h>
#include <firstcontact/scene_files/detail/result_json.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace detail {
namespace {

/// Writes a report; parts without contents are left out.
JsonValue report_json(const FileReport& report) {
  JsonArray contents;
  for (const FileContent& content : report.contents) {
    contents.push_back(
        {.value = JsonObject{{"what", to_json(content.what)}, {"count", to_json(content.count)}}});
  }
  JsonObject object{{"path", to_json(report.path)},
                    {"format", to_json(report.format)},
                    {"contents", {.value = std::move(contents)}}};
  if (!report.unit.empty()) {
    object.push_back({"unit", to_json(report.unit)});
  }
  if (!report.left_out.empty()) {
    JsonArray left_out;
    for (const LeftOut& passed_over : report.left_out) {
      left_out.push_back({.value = JsonObject{{"name", to_json(passed_over.name)},
                                              {"reason", to_json(passed_over.reason)},
                                              {"count", to_json(passed_over.count)}}});
    }
    object.push_back({"left_out", {.value = std::move(left_out)}});
  }
  if (!report.warnings.empty()) {
    object.push_back({"warnings", to_json(report.warnings)});
  }
  if (!report.also_read.empty()) {
    object.push_back({"also_read", to_json(report.also_read)});
  }
  return {.value = std::move(object)};
}

}  // namespace

JsonValue reports_json(std::span<const FileReport> reports) {
  JsonArray array;
  for (const FileReport& report : reports) {
    array.push_back(report_json(report));
  }
  return {.value = std::move(array)};
}

JsonValue pair_counts_json(const PairCounts& counts) {
  JsonArray untested;
  for (const UntestedPairs& pairs : counts.untested) {
    JsonArray first;
    for (const auto& [one, other] : pairs.first) {
      first.push_back(two(to_json(one), to_json(other)));
    }
    untested.push_back({.value = JsonObject{{"why", to_json(word(pairs.why))},
                                            {"count", to_json(pairs.count)},
                                            {"first", {.value = std::move(first)}}}});
  }
  return {.value = JsonObject{{"tested", to_json(counts.tested)},
                              {"ignored", to_json(counts.ignored())},
                              {"left_out", to_json(counts.left_out())},
                              {"untested", {.value = std::move(untested)}}}};
}

}  // namespace detail

std::string write_file_reports(std::span<const FileReport> reports) {
  return detail::write_json(detail::reports_json(reports));
}

std::string write_pair_counts(const PairCounts& counts) {
  return detail::write_json(detail::pair_counts_json(counts));
}

}  // namespace firstcontact
