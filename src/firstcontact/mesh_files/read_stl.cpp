#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include <firstcontact/mesh_files/detail/parse_mesh.h>
#include <firstcontact/mesh_files/read_mesh.h>
#include <firstcontact/polygons/detail/mesh_builder.h>
#include <firstcontact/text/ascii.h>
#include <firstcontact/text/byte_cursor.h>
#include <firstcontact/text/text_cursor.h>

namespace firstcontact {
namespace {

using detail::ByteCursor;
using detail::MeshBuilder;
using detail::ReadingLog;
using detail::TextCursor;

constexpr std::size_t kHeader = 80;
constexpr std::size_t kFacet = 50;
constexpr std::size_t kMoreThanKeyword = 16;  // Longer words are not keywords.

bool size_fits_count(std::string_view data) {
  if (data.size() < kHeader + 4) {
    return false;
  }
  ByteCursor bytes(data.substr(kHeader), {}, /*big_endian=*/false);
  return data.size() - kHeader - 4 == std::uint64_t{bytes.read<std::uint32_t>("")} * kFacet;
}

/// Whether data looks like text. Some binary files begin with "solid" too, but their count has a
/// zero byte.
bool looks_like_text(std::string_view data) {
  data = detail::without_byte_order_mark(data);
  const std::size_t start = data.find_first_not_of(" \t\r\n\v\f");
  return start != data.npos && detail::lower(data.substr(start, 5)) == "solid" &&
         data.substr(0, 1024).find('\0') == data.npos;
}

/// Refuses sizes that contradict the count. Blanks or zeros at the end are a warning.
void check_size(const ByteCursor& bytes, std::uint64_t count, ReadingLog& log) {
  const std::uint64_t size = bytes.remaining();
  const std::size_t end = bytes.offset() + bytes.remaining();
  if (count == 0 && size >= kFacet) {
    throw ParseError::at_byte(log.path(), kHeader,
                              "count says 0, bytes of " + std::to_string(size / kFacet) +
                                  " triangles follow: expected the number of triangles");
  }
  if (size < count * kFacet) {
    throw ParseError::at_byte(log.path(), end,
                              "expected " + std::to_string(kHeader + 4 + count * kFacet) +
                                  " bytes for " + std::to_string(count) +
                                  " triangles, got the end of the file");
  }
  const std::string_view rest = bytes.rest().substr(count * kFacet);
  if (rest.empty()) {
    return;
  }
  const ParseError left_over = ParseError::at_byte(
      log.path(), end - rest.size(),
      std::to_string(rest.size()) + (rest.size() == 1 ? " byte is" : " bytes are") +
          " left over after " + std::to_string(count) + (count == 1 ? " triangle" : " triangles"));
  if (rest.find_first_not_of(std::string_view(" \t\r\n\0\x1a", 6)) != rest.npos) {
    throw ParseError::at_byte(log.path(), *left_over.offset(),
                              left_over.message() + ": expected the end of the file");
  }
  log.warn(left_over);
}

Mesh parse_binary(std::string_view data, ReadingLog& log) {
  if (data.size() < kHeader + 4) {
    throw ParseError::at_byte(log.path(), data.size(),
                              "expected STL: 'solid', or a header of 84 bytes");
  }
  ByteCursor bytes(data, log.path(), /*big_endian=*/false);
  bytes.skip(kHeader, "the header");
  const std::uint64_t count = bytes.read<std::uint32_t>("the number of triangles");
  check_size(bytes, count, log);
  MeshBuilder mesh;
  mesh.reserve_vertices(3 * count, 3 * bytes.remaining(), kFacet);
  mesh.reserve_triangles(count, bytes.remaining(), kFacet);
  for (std::uint64_t i = 0; i < count; ++i) {
    bytes.skip(12, "a normal");
    mesh.begin_polygon(bytes.offset());
    for (int k = 0; k < 3; ++k) {
      const std::size_t place = bytes.offset();
      const float x = bytes.read<float>("a coordinate");
      const float y = bytes.read<float>("a coordinate");
      const float z = bytes.read<float>("a coordinate");
      if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) {
        throw ParseError::at_byte(log.path(), place,
                                  "expected finite coordinates of triangle " + std::to_string(i));
      }
      if (!mesh.add_vertex({x, y, z}) ||
          !mesh.add_corner(static_cast<std::int64_t>(mesh.vertex_count()) - 1)) {
        throw ParseError::at_byte(log.path(), place, "expected fewer than 2^32 vertices");
      }
    }
    mesh.end_polygon();
    bytes.skip(2, "the attributes");
  }
  if (mesh.is_empty()) {
    throw ParseError(log.path(), "expected at least one triangle, found none");
  }
  log.leave_out("normals and attributes of triangles", "normals and colours", count);
  return mesh.finish(log);
}

/// Reads the next word, in lower case, on any line; empty at the end of the file.
std::string keyword(TextCursor& text) {
  return text.find_line() ? detail::lower(text.word().substr(0, kMoreThanKeyword)) : std::string();
}

void expect(TextCursor& text, std::string_view wanted) {
  (void)text.find_line();
  TextCursor before = text;
  if (keyword(text) != wanted) {
    before.fail_at_word("'" + std::string(wanted) + "'");
  }
}

/// Skips the name of a solid: it goes to the end of the line, or to its first facet there.
void skip_name(TextCursor& text) {
  while (!text.at_line_end()) {
    TextCursor ahead = text;
    if (keyword(ahead) == "facet" && !ahead.at_line_end() && keyword(ahead) == "normal") {
      return;
    }
    (void)text.word();
  }
}

/// Skips a normal, which often is not a number: the words of its line, or three on several lines.
void skip_normal(TextCursor& text) {
  for (int words = 0; (words < 3 || !text.at_line_end()) && text.find_line(); ++words) {
    TextCursor ahead = text;
    if (keyword(ahead) == "outer") {
      return;
    }
    (void)text.word();
  }
}

double coordinate(TextCursor& text) {
  (void)text.find_line();
  return text.number("a finite coordinate");
}

void read_facet(TextCursor& text, MeshBuilder& mesh) {
  expect(text, "normal");
  skip_normal(text);
  expect(text, "outer");
  expect(text, "loop");
  mesh.begin_polygon(text.line());
  for (int k = 0; k < 3; ++k) {
    expect(text, "vertex");
    const double x = coordinate(text);
    const double y = coordinate(text);
    const double z = coordinate(text);
    if (!mesh.add_vertex({x, y, z}) ||
        !mesh.add_corner(static_cast<std::int64_t>(mesh.vertex_count()) - 1)) {
      text.fail("expected fewer than 2^32 vertices");
    }
  }
  mesh.end_polygon();
  expect(text, "endloop");
  expect(text, "endfacet");
}

/// Reads the facets of a solid to its end, and returns the number of solids. Where the next solid
/// begins before the end, nothing is missing. At the end of the file the rest may be cut off.
std::size_t read_facets(TextCursor& text, MeshBuilder& mesh, ReadingLog& log) {
  for (std::size_t solids = 1;;) {
    const bool more = text.find_line();
    TextCursor before = text;
    const std::string word = keyword(text);
    if (word == "endsolid") {
      text.skip_line();
      return solids;
    }
    if (word == "solid") {
      log.warn(ParseError(log.path(), text.line(), "'endsolid' is missing before this solid"),
               "missing endsolid");
      skip_name(text);
      ++solids;
      continue;
    }
    if (!more && !mesh.is_empty()) {
      log.refuse(ParseError(log.path(), text.line(),
                            "expected 'facet' or 'endsolid', got the end of the file"));
      return solids;
    }
    if (word != "facet") {
      before.fail_at_word("'facet' or 'endsolid'");
    }
    read_facet(text, mesh);
  }
}

Mesh parse_ascii(std::string_view data, ReadingLog& log) {
  TextCursor text(detail::without_byte_order_mark(data), log.path(), {});
  MeshBuilder mesh;
  std::size_t solids = 0;
  while (text.find_line()) {
    expect(text, "solid");
    skip_name(text);
    solids += read_facets(text, mesh, log);
  }
  if (mesh.is_empty()) {
    throw ParseError(log.path(), "expected at least one triangle, found none");
  }
  if (solids > 1) {
    log.add_content("solids", solids);
  }
  Mesh result = mesh.finish(log);
  log.leave_out("facet normal", "normals", result.triangles.size());
  return result;
}

}  // namespace

Mesh detail::parse_stl(std::string_view data, ReadingLog& log) {
  const bool text = !size_fits_count(data) && looks_like_text(data);
  return text ? parse_ascii(data, log) : parse_binary(data, log);
}

Mesh parse_stl(std::string_view data, const std::string& source) {
  return detail::parse_unlogged([](auto bytes, auto& log) { return detail::parse_stl(bytes, log); },
                                data, source);
}

}  // namespace firstcontact
