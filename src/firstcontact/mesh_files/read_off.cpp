#include <cstdint>
#include <string>
#include <string_view>

#include <firstcontact/mesh_files/detail/parse_mesh.h>
#include <firstcontact/mesh_files/read_mesh.h>
#include <firstcontact/polygons/detail/mesh_builder.h>
#include <firstcontact/text/text_cursor.h>

namespace firstcontact {
namespace {

using detail::MeshBuilder;
using detail::TextCursor;

bool consume(std::string_view& text, std::string_view prefix) {
  const bool found = text.substr(0, prefix.size()) == prefix;
  text.remove_prefix(found ? prefix.size() : 0);
  return found;
}

/// Reads the header [ST][C][N]OFF; the counts may follow on the same line.
void read_header(TextCursor& text) {
  const std::string_view word = text.find_line() ? text.word() : std::string_view();
  std::string_view rest = word;
  consume(rest, "ST");
  consume(rest, "C");
  consume(rest, "N");
  if (rest != "OFF") {
    text.fail("expected the header OFF (or COFF, NOFF, STOFF), got " + detail::quoted(word));
  }
}

std::uint64_t read_count(TextCursor& text, const char* what) {
  if (!text.find_line()) {
    text.fail_at_word(what);
  }
  const std::int64_t count = text.integer(what);
  if (count < 0) {
    text.fail(std::string("expected ") + what + ", got " + std::to_string(count));
  }
  return static_cast<std::uint64_t>(count);
}

[[noreturn]] void fail_cut_off(TextCursor& text, const char* what, std::uint64_t i,
                               std::uint64_t count) {
  text.fail("expected " + std::string(what) + " " + std::to_string(i + 1) + " of " +
            std::to_string(count) + ", got the end of the file");
}

/// The numbers of columns of vertices and faces that are no geometry.
struct LeftOutColumns {
  std::size_t of_vertices = 0;
  std::size_t of_faces = 0;
  std::size_t empty_faces = 0;
};

void read_vertices(TextCursor& text, MeshBuilder& mesh, std::uint64_t count,
                   LeftOutColumns& left_out) {
  mesh.reserve_vertices(count, text.remaining(), 6);
  for (std::uint64_t i = 0; i < count; ++i) {
    if (!text.find_line()) {
      fail_cut_off(text, "vertex", i, count);
    }
    const double x = text.number("a finite coordinate");
    const double y = text.number("a finite coordinate");
    const double z = text.number("a finite coordinate");
    if (!mesh.add_vertex({x, y, z})) {
      text.fail("expected fewer than 2^32 vertices");
    }
    left_out.of_vertices += text.at_line_end() ? 0 : 1;
    text.skip_line();
  }
}

void read_face(TextCursor& text, MeshBuilder& mesh, LeftOutColumns& left_out) {
  const std::int64_t corners = text.integer("a number of corners");
  if (corners < 0) {
    text.fail("expected a number of corners, got " + std::to_string(corners));
  }
  left_out.empty_faces += corners == 0 ? 1 : 0;
  mesh.begin_polygon(text.line());
  for (std::int64_t k = 0; k < corners; ++k) {
    const std::int64_t index = text.integer("a vertex index");
    if (index < 0 || index >= static_cast<std::int64_t>(mesh.vertex_count()) ||
        !mesh.add_corner(index)) {
      text.fail("vertex index " + std::to_string(index) + " is out of range: the file has " +
                std::to_string(mesh.vertex_count()) + " vertices");
    }
  }
  mesh.end_polygon();
  left_out.of_faces += text.at_line_end() ? 0 : 1;
  text.skip_line();
}

void report(const LeftOutColumns& left_out, detail::ReadingLog& log) {
  if (left_out.of_vertices > 0) {
    log.leave_out("columns after x, y and z", "colours, normals and textures",
                  left_out.of_vertices);
  }
  if (left_out.of_faces > 0) {
    log.leave_out("columns after the corners", "colours of faces", left_out.of_faces);
  }
  if (left_out.empty_faces > 0) {
    log.leave_out("faces without corners", "no surface", left_out.empty_faces);
  }
}

}  // namespace

Mesh detail::parse_off(std::string_view data, ReadingLog& log) {
  TextCursor text(without_byte_order_mark(data), log.path(),
                  {.comments = true, .continuation = false});
  read_header(text);
  const std::uint64_t vertices = read_count(text, "a number of vertices");
  const std::uint64_t faces = read_count(text, "a number of faces");
  text.skip_line();  // The number of edges is often wrong, and not needed.
  MeshBuilder mesh;
  LeftOutColumns left_out;
  read_vertices(text, mesh, vertices, left_out);
  mesh.reserve_triangles(faces, text.remaining(), 4);
  for (std::uint64_t i = 0; i < faces; ++i) {
    if (!text.find_line()) {
      fail_cut_off(text, "face", i, faces);
    }
    read_face(text, mesh, left_out);
  }
  if (text.find_line()) {
    text.fail_at_word("the end of the file after " + std::to_string(faces) + " faces");
  }
  if (mesh.is_empty()) {
    throw ParseError(log.path(), "expected at least one face, found none");
  }
  report(left_out, log);
  return mesh.finish(log);
}

Mesh parse_off(std::string_view text, const std::string& source) {
  return detail::parse_unlogged([](auto bytes, auto& log) { return detail::parse_off(bytes, log); },
                                text, source);
}

}  // namespace firstcontact
