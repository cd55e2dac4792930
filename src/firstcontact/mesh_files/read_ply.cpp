#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <firstcontact/mesh_files/detail/parse_mesh.h>
#include <firstcontact/mesh_files/read_mesh.h>
#include <firstcontact/mesh_files/read_points.h>
#include <firstcontact/polygons/detail/mesh_builder.h>
#include <firstcontact/text/byte_cursor.h>
#include <firstcontact/text/text_cursor.h>

namespace firstcontact {
namespace {

using detail::ByteCursor;
using detail::MeshBuilder;
using detail::ReadingLog;
using detail::TextCursor;

enum class Type { i8, u8, i16, u16, i32, u32, f32, f64 };

/// The role of a property.
enum class Role { other, x, y, z, corners };

struct Property {
  std::string name;
  Type type = Type::f32;
  std::optional<Type> count_type;  ///< Type of the count of a list.
  Role role = Role::other;
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

enum class Format { ascii, little_endian, big_endian };

struct Header {
  std::optional<Format> format;
  std::vector<Element> elements;
};

bool is_integer(Type type) { return type != Type::f32 && type != Type::f64; }

Type read_type(TextCursor& text) {
  static constexpr std::array<std::pair<std::string_view, Type>, 16> kTypes = {{
      {"char", Type::i8},
      {"int8", Type::i8},
      {"uchar", Type::u8},
      {"uint8", Type::u8},
      {"short", Type::i16},
      {"int16", Type::i16},
      {"ushort", Type::u16},
      {"uint16", Type::u16},
      {"int", Type::i32},
      {"int32", Type::i32},
      {"uint", Type::u32},
      {"uint32", Type::u32},
      {"float", Type::f32},
      {"float32", Type::f32},
      {"double", Type::f64},
      {"float64", Type::f64},
  }};
  const std::string_view word = text.word();
  for (const auto& [name, type] : kTypes) {
    if (word == name) {
      return type;
    }
  }
  text.fail("expected a type (char, uchar, short, ushort, int, uint, float, double), got " +
            detail::quoted(word));
}

Type read_integer_type(TextCursor& text) {
  const Type type = read_type(text);
  if (!is_integer(type)) {
    text.fail("expected an integer type");
  }
  return type;
}

void read_property(TextCursor& text, Element& element) {
  TextCursor ahead = text;
  const bool is_list = ahead.word() == "list";
  Property property;
  if (is_list) {
    text.word();
    property.count_type = read_integer_type(text);
  }
  property.type = read_type(text);
  const std::string_view name = text.word();
  property.name = name;
  if (element.name == "vertex" && !is_list) {
    property.role = name == "x"   ? Role::x
                    : name == "y" ? Role::y
                    : name == "z" ? Role::z
                                  : Role::other;
  } else if (element.name == "face" && (name == "vertex_indices" || name == "vertex_index")) {
    if (!is_list || !is_integer(property.type)) {
      text.fail("expected " + std::string(name) + " to be a list of integers");
    }
    property.role = Role::corners;
  }
  for (const Property& earlier : element.properties) {
    if (property.role != Role::other && earlier.role == property.role) {
      text.fail("property " + detail::quoted(name) + " is given twice");
    }
  }
  element.properties.push_back(property);
}

void read_format(TextCursor& text, Header& header) {
  const std::string_view word = text.word();
  if (word == "ascii") {
    header.format = Format::ascii;
  } else if (word == "binary_little_endian") {
    header.format = Format::little_endian;
  } else if (word == "binary_big_endian") {
    header.format = Format::big_endian;
  } else {
    text.fail("expected ascii, binary_little_endian or binary_big_endian, got " +
              detail::quoted(word));
  }
}

void read_element(TextCursor& text, Header& header) {
  Element element;
  element.name = text.word();
  const std::int64_t count = text.integer("a number of elements");
  if (count < 0) {
    text.fail("expected a number of elements, got " + std::to_string(count));
  }
  element.count = static_cast<std::uint64_t>(count);
  if (element.name == "tristrips" && count > 0) {
    text.fail("triangle strips are not supported: expected the element 'face'");
  }
  if (element.name == "range_grid" && count > 0) {
    text.fail("range images are not supported: expected the element 'face'");
  }
  for (const Element& earlier : header.elements) {
    if ((element.name == "vertex" || element.name == "face") && earlier.name == element.name) {
      text.fail("element " + detail::quoted(element.name) + " is given twice");
    }
  }
  header.elements.push_back(std::move(element));
}

/// The content that is wanted from a file.
enum class Wanted { mesh, points };

void check_header(const TextCursor& text, const Header& header, Wanted wanted) {
  if (!header.format) {
    text.fail("expected a line 'format' in the header");
  }
  int coordinates = 0;
  int corner_lists = 0;
  for (const Element& element : header.elements) {
    for (const Property& property : element.properties) {
      corner_lists += property.role == Role::corners ? 1 : 0;
      coordinates += property.role != Role::corners && property.role != Role::other ? 1 : 0;
    }
  }
  if (coordinates != 3) {
    text.fail("expected an element 'vertex' with properties x, y and z");
  }
  if (corner_lists != 1 && wanted == Wanted::mesh) {
    text.fail("expected an element 'face' with a list vertex_indices");
  }
}

/// Reads the header, up to the line feed of end_header.
Header read_header(TextCursor& text, Wanted wanted) {
  if (text.word() != "ply") {
    text.fail("expected the header 'ply'");
  }
  Header header;
  for (;;) {
    text.skip_line();
    const std::string_view keyword = text.word();
    if (keyword == "end_header") {
      check_header(text, header, wanted);
      text.skip_line();
      return header;
    }
    if (keyword == "format") {
      read_format(text, header);
    } else if (keyword == "element") {
      read_element(text, header);
    } else if (keyword == "property" && !header.elements.empty()) {
      read_property(text, header.elements.back());
    } else if (keyword != "comment" && keyword != "obj_info") {
      text.fail("expected format, element, property, comment or end_header, got " +
                detail::quoted(keyword));
    }
  }
}

/// The body of an ASCII file. Both kinds of body have the same functions.
class AsciiBody {
 public:
  static constexpr MeshBuilder::Place kPlaces = MeshBuilder::Place::line;
  static constexpr std::size_t kLeastVertex = 6;  ///< [byte]  "0 0 0\n"
  static constexpr std::size_t kLeastFace = 4;

  explicit AsciiBody(const TextCursor& text) : text_(text) {}

  void begin(const std::string& name, std::uint64_t i, std::uint64_t count) {
    if (!text_.find_line()) {
      text_.fail("expected " + name + " " + std::to_string(i + 1) + " of " + std::to_string(count) +
                 ", got the end of the file");
    }
  }
  double real(Type) { return text_.number("a finite coordinate"); }
  std::int64_t integer(Type, const char* what) { return text_.integer(what); }
  void skip(Type) {
    if (text_.word().empty()) {
      text_.fail_at_word("a number");
    }
  }
  void skip_list(Type type, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
      skip(type);
    }
  }
  void end() { text_.expect_line_end(); }
  void end_all() {
    if (text_.find_line()) {
      text_.fail_at_word("the end of the file after the last element");
    }
  }
  [[nodiscard]] std::size_t remaining() const { return text_.remaining(); }
  [[nodiscard]] std::size_t place() const { return text_.line(); }
  [[noreturn]] void fail(const std::string& message) const { text_.fail(message); }
  [[noreturn]] void fail_at(std::size_t place, const std::string& source,
                            const std::string& message) const {
    throw ParseError(source, place, message);
  }

 private:
  TextCursor text_;
};

class BinaryBody {
 public:
  static constexpr MeshBuilder::Place kPlaces = MeshBuilder::Place::byte;
  static constexpr std::size_t kLeastVertex = 3;
  static constexpr std::size_t kLeastFace = 1;

  explicit BinaryBody(ByteCursor bytes) : bytes_(std::move(bytes)) {}

  void begin(const std::string& name, std::uint64_t i, std::uint64_t count) {
    if (bytes_.remaining() == 0) {
      bytes_.fail("expected " + name + " " + std::to_string(i + 1) + " of " +
                  std::to_string(count) + ", got the end of the file");
    }
  }
  double real(Type type) {
    const double value = type == Type::f32   ? bytes_.read<float>("a coordinate")
                         : type == Type::f64 ? bytes_.read<double>("a coordinate")
                                             : static_cast<double>(integer(type, "a coordinate"));
    if (!std::isfinite(value)) {
      bytes_.fail("expected a finite coordinate before this byte");
    }
    return value;
  }
  std::int64_t integer(Type type, const char* what) {
    switch (type) {
      case Type::i8:
        return bytes_.read<std::int8_t>(what);
      case Type::u8:
        return bytes_.read<std::uint8_t>(what);
      case Type::i16:
        return bytes_.read<std::int16_t>(what);
      case Type::u16:
        return bytes_.read<std::uint16_t>(what);
      case Type::i32:
        return bytes_.read<std::int32_t>(what);
      default:
        return bytes_.read<std::uint32_t>(what);
    }
  }
  void skip(Type type) { bytes_.skip(size(type), "a property"); }
  void skip_list(Type type, std::uint64_t count) {
    bytes_.skip(size(type) * count, "a list");  // The count has at most 32 bits.
  }
  void end() {}
  void end_all() {
    if (bytes_.rest().find_first_not_of(" \t\r\n") != std::string_view::npos) {
      bytes_.fail("expected the end of the file after the last element");
    }
  }
  [[nodiscard]] std::size_t remaining() const { return bytes_.remaining(); }
  [[nodiscard]] std::size_t place() const { return bytes_.offset(); }
  [[noreturn]] void fail(const std::string& message) const { bytes_.fail(message); }
  [[noreturn]] void fail_at(std::size_t place, const std::string& source,
                            const std::string& message) const {
    throw ParseError::at_byte(source, place, message);
  }

 private:
  static std::size_t size(Type type) {
    static constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<std::size_t>(type)];
  }

  ByteCursor bytes_;
};

template <class Body>
std::uint64_t read_list_size(Body& body, Type type) {
  const std::int64_t count = body.integer(type, "the length of a list");
  if (count < 0 || count > std::int64_t{0xffffffff}) {
    body.fail("expected the length of a list, got " + std::to_string(count));
  }
  return static_cast<std::uint64_t>(count);
}

/// Reads the corners of a face. Returns their number.
template <class Body>
std::uint64_t read_corners(Body& body, MeshBuilder& mesh, const Property& property) {
  const std::uint64_t count = read_list_size(body, *property.count_type);
  mesh.begin_polygon(body.place());
  for (std::uint64_t k = 0; k < count; ++k) {
    const std::int64_t index = body.integer(property.type, "a vertex index");
    if (!mesh.add_corner(index)) {
      body.fail("vertex index " + std::to_string(index) + " is out of range");
    }
  }
  mesh.end_polygon();
  return count;
}

/// Reads the items of an element. Returns the number of faces without a corner.
template <class Body>
std::uint64_t read_items(Body& body, MeshBuilder& mesh, const Element& element) {
  std::uint64_t empty = 0;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    body.begin(element.name, i, element.count);
    Eigen::Vector3d p;
    for (const Property& property : element.properties) {
      if (property.role == Role::corners) {
        empty += read_corners(body, mesh, property) == 0 ? 1 : 0;
      } else if (property.role != Role::other) {
        p[static_cast<int>(property.role) - static_cast<int>(Role::x)] = body.real(property.type);
      } else if (property.count_type) {
        body.skip_list(property.type, read_list_size(body, *property.count_type));
      } else {
        body.skip(property.type);
      }
    }
    body.end();
    if (element.name == "vertex" && !mesh.add_vertex(p)) {
      body.fail("expected fewer than 2^32 vertices");
    }
  }
  return empty;
}

/// Notes all properties and elements that are not vertices, coordinates or faces.
void report_left_out(const Element& element, ReadingLog& log, Wanted wanted) {
  if (element.count == 0 || (element.name == "face" && wanted == Wanted::points)) {
    return;
  }
  if (element.name == "edge") {
    log.warn(ParseError(log.path(), "the element 'edge' is left out: its " +
                                        std::to_string(element.count) +
                                        " edges are no part of the surface"));
  }
  if (element.name != "vertex" && element.name != "face") {
    log.leave_out("element '" + element.name + "'", "neither vertices nor faces",
                  static_cast<std::size_t>(element.count));
    return;
  }
  for (const Property& property : element.properties) {
    if (property.role == Role::other) {
      log.leave_out("property '" + property.name + "' of '" + element.name + "'",
                    "colours, normals and other values", static_cast<std::size_t>(element.count));
    }
  }
}

template <class Body>
Mesh read_body(Body body, const std::vector<Element>& elements, ReadingLog& log, Wanted wanted) {
  MeshBuilder mesh(Body::kPlaces);
  for (const Element& element : elements) {
    if (element.name == "vertex") {
      mesh.reserve_vertices(element.count, body.remaining(), Body::kLeastVertex);
    } else if (element.name == "face") {
      mesh.reserve_triangles(element.count, body.remaining(), Body::kLeastFace);
    }
    if (!element.properties.empty()) {
      if (const std::uint64_t empty = read_items(body, mesh, element); empty > 0) {
        log.leave_out("faces without corners", "no surface", static_cast<std::size_t>(empty));
      }
    }
    report_left_out(element, log, wanted);
  }
  body.end_all();
  if (mesh.has_range_error()) {
    body.fail_at(mesh.greatest().place, log.path(),
                 "vertex index " + std::to_string(mesh.greatest().index_end - 1) +
                     " is out of range: the file has " + std::to_string(mesh.vertex_count()) +
                     " vertices");
  }
  if (mesh.is_empty() && wanted == Wanted::mesh) {
    throw ParseError(log.path(), "expected at least one face, found none");
  }
  return wanted == Wanted::mesh ? mesh.finish(log) : Mesh{mesh.take_vertices(), {}};
}

Mesh parse(std::string_view data, ReadingLog& log, Wanted wanted) {
  TextCursor text(data, log.path(), {});
  const Header header = read_header(text, wanted);
  if (header.format == Format::ascii) {
    return read_body(AsciiBody(text), header.elements, log, wanted);
  }
  const std::size_t begin = data.size() - text.remaining();
  ByteCursor bytes(data.substr(begin), log.path(), header.format == Format::big_endian, begin);
  return read_body(BinaryBody(std::move(bytes)), header.elements, log, wanted);
}

}  // namespace

Mesh detail::parse_ply(std::string_view data, ReadingLog& log) {
  return parse(data, log, Wanted::mesh);
}

Mesh parse_ply(std::string_view data, const std::string& source) {
  return detail::parse_unlogged([](auto bytes, auto& log) { return detail::parse_ply(bytes, log); },
                                data, source);
}

std::vector<Eigen::Vector3d> parse_ply_points(std::string_view data, const std::string& source) {
  return detail::parse_unlogged(
      [](auto bytes, auto& log) { return detail::parse_ply_points(bytes, log); }, data, source);
}

std::vector<Eigen::Vector3d> detail::parse_ply_points(std::string_view data, ReadingLog& log) {
  Mesh mesh = parse(data, log, Wanted::points);
  if (mesh.vertices.empty()) {
    throw ParseError(log.path(), "expected at least one vertex, found none");
  }
  return std::move(mesh.vertices);
}

}  // namespace firstcontact
