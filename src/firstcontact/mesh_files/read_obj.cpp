#include <algorithm>
#include <array>
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

constexpr const char* kCoordinate = "a finite coordinate";
constexpr const char* kCorner = "a vertex index (v, v/vt, v//vn or v/vt/vn)";

struct LeftOutStatement {
  std::string_view keyword;
  std::string_view reason;
};

// Statements that change no geometry. Anything else unknown is refused, as it may be a surface.
constexpr std::array<LeftOutStatement, 20> kLeftOut = {{{"vn", "normals"},
                                                        {"vt", "texture coordinates"},
                                                        {"vp", "parameters of curved surfaces"},
                                                        {"g", "names of groups"},
                                                        {"o", "names of objects"},
                                                        {"s", "smooth shading"},
                                                        {"mg", "smooth shading"},
                                                        {"usemtl", "materials"},
                                                        {"mtllib", "materials"},
                                                        {"usemap", "textures"},
                                                        {"maplib", "textures"},
                                                        {"c_interp", "colours"},
                                                        {"d_interp", "looks"},
                                                        {"trace_obj", "looks"},
                                                        {"shadow_obj", "looks"},
                                                        {"bevel", "looks"},
                                                        {"lod", "looks"},
                                                        {"ctech", "drawing of curved surfaces"},
                                                        {"stech", "drawing of curved surfaces"},
                                                        {"lines of whole numbers", "counts"}}};

/// Index of lines of counts: the last of the table, whose name no statement can have.
constexpr std::size_t kCounts = kLeftOut.size() - 1;

/// Numbers of left-out statements, by their place in the table.
using LeftOutCounts = std::array<std::size_t, kLeftOut.size()>;

void read_vertex(TextCursor& text, MeshBuilder& mesh) {
  std::array<double, 7> values{};
  std::size_t count = 0;
  while (count < 3 || !text.at_line_end()) {
    if (count == values.size()) {
      text.fail_at_word("the end of the line");
    }
    values[count] = text.number(count < 3 ? kCoordinate : "a finite weight or colour");
    ++count;
  }
  if (count == 5) {
    text.fail("expected x y z, x y z w or x y z r g b, got 5 numbers");
  }
  if (count == 4 && values[3] != 1.0) {
    text.fail("expected a vertex weight of 1");
  }
  if (!mesh.add_vertex({values[0], values[1], values[2]})) {
    text.fail("expected fewer than 2^32 vertices");
  }
}

/// Reads `v`, `v/vt`, `v//vn` or `v/vt/vn`, and returns the index from 0.
std::int64_t read_corner(TextCursor& text, const MeshBuilder& mesh) {
  const std::int64_t number = text.integer_prefix(kCorner);
  if (text.take('/')) {
    if (!text.take('/')) {
      text.integer_prefix(kCorner);
      if (text.take('/')) {
        text.integer_prefix(kCorner);
      }
    } else {
      text.integer_prefix(kCorner);
    }
  }
  if (!text.at_delimiter()) {
    text.fail_at_word("a blank after the vertex index");
  }
  // A negative number counts back from the newest vertex.
  const std::int64_t index =
      number > 0 ? number - 1 : static_cast<std::int64_t>(mesh.vertex_count()) + number;
  if (number == 0 || index < 0) {
    text.fail("vertex index " + std::to_string(number) +
              " is out of range: " + std::to_string(mesh.vertex_count()) + " vertices so far");
  }
  return index;
}

void add_corner(TextCursor& text, MeshBuilder& mesh, std::int64_t index) {
  if (!mesh.add_corner(index)) {
    text.fail("vertex index " + std::to_string(index + 1) + " is out of range");
  }
}

void read_polygon(TextCursor& text, MeshBuilder& mesh) {
  mesh.begin_polygon(text.line());
  while (!text.at_line_end()) {
    add_corner(text, mesh, read_corner(text, mesh));
  }
  if (mesh.end_polygon() == 0) {
    text.fail_at_word(kCorner);
  }
}

/// Reads the corners of `p`, each on its own, or of `l`, each with the one before.
void read_simplices(TextCursor& text, MeshBuilder& mesh, bool joined) {
  std::size_t count = 0;
  std::int64_t previous = 0;
  for (; !text.at_line_end(); ++count) {
    const std::int64_t index = read_corner(text, mesh);
    if (!joined || count > 0) {
      mesh.begin_polygon(text.line());
      add_corner(text, mesh, joined ? previous : index);
      add_corner(text, mesh, index);
      mesh.end_polygon();
    }
    previous = index;
  }
  if (count < (joined ? 2u : 1u)) {
    text.fail_at_word(kCorner);
  }
}

/// Whether a line has counts only: some exporters begin with the numbers of vertices and faces.
bool is_counts(std::string_view word, TextCursor& text) {
  while (!word.empty() && word.find_first_not_of("0123456789") == word.npos) {
    word = text.word();
  }
  return word.empty();
}

void read_statement(TextCursor& text, MeshBuilder& mesh, LeftOutCounts& left_out) {
  const std::string_view keyword = text.word();
  if (keyword == "v") {
    read_vertex(text, mesh);
  } else if (keyword == "f") {
    read_polygon(text, mesh);
  } else if (keyword == "l" || keyword == "p") {
    read_simplices(text, mesh, keyword == "l");
  } else {
    const auto* known = std::find_if(
        kLeftOut.begin(), kLeftOut.end(),
        [&](const LeftOutStatement& statement) { return statement.keyword == keyword; });
    if (known != kLeftOut.end()) {
      ++left_out[static_cast<std::size_t>(known - kLeftOut.begin())];
    } else if (is_counts(keyword, text)) {
      ++left_out[kCounts];
    } else {
      text.fail("expected an OBJ statement (v, vn, vt, f, l, p, g, o, s, usemtl ...), got " +
                detail::quoted(keyword));
    }
  }
}

void report(const LeftOutCounts& left_out, detail::ReadingLog& log) {
  for (std::size_t i = 0; i < left_out.size(); ++i) {
    if (left_out[i] > 0) {
      log.leave_out(kLeftOut[i].keyword, kLeftOut[i].reason, left_out[i]);
    }
  }
}

}  // namespace

Mesh detail::parse_obj(std::string_view data, ReadingLog& log) {
  TextCursor text(detail::without_byte_order_mark(data), log.path(),
                  {.comments = true, .continuation = true});
  MeshBuilder mesh;
  LeftOutCounts left_out{};
  while (text.find_line()) {
    read_statement(text, mesh, left_out);
    text.skip_line();
  }
  if (mesh.has_range_error()) {
    throw ParseError(log.path(), mesh.greatest().place,
                     "vertex index " + std::to_string(mesh.greatest().index_end) +
                         " is out of range: the file has " + std::to_string(mesh.vertex_count()) +
                         " vertices");
  }
  if (mesh.is_empty()) {
    throw ParseError(log.path(), "expected at least one face, line or point, found none");
  }
  report(left_out, log);
  return mesh.finish(log);
}

Mesh parse_obj(std::string_view text, const std::string& source) {
  return detail::parse_unlogged([](auto bytes, auto& log) { return detail::parse_obj(bytes, log); },
                                text, source);
}

}  // namespace firstcontact
