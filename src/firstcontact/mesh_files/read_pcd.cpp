#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/mesh_files/detail/lzf.h>
#include <firstcontact/mesh_files/read_points.h>
#include <firstcontact/text/byte_cursor.h>
#include <firstcontact/text/text_cursor.h>

namespace firstcontact {
namespace {

using detail::ByteCursor;
using detail::TextCursor;
using Eigen::Vector3d;

struct Field {
  std::string_view name;
  std::int64_t size = 4;  ///< [byte]
  char type = 'F';        ///< F, I or U.
  std::int64_t count = 1;

  [[nodiscard]] std::size_t bytes() const { return static_cast<std::size_t>(size * count); }
};

enum class Data { ascii, binary, compressed };

struct Header {
  std::vector<Field> fields;
  std::array<std::size_t, 3> coordinates{};  ///< Indices of the fields x, y and z.
  std::optional<std::int64_t> width;
  std::optional<std::int64_t> height;
  std::optional<std::int64_t> points;
  Data data = Data::ascii;

  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(*points); }
  [[nodiscard]] std::size_t point_bytes() const {
    std::size_t sum = 0;
    for (const Field& field : fields) {
      sum += field.bytes();
    }
    return sum;
  }
};

void read_fields(TextCursor& text, Header& header) {
  while (!text.at_line_end()) {
    header.fields.push_back({.name = text.word()});
  }
}

/// Reads one value for each field, in their order.
template <class Read>
void read_for_each_field(TextCursor& text, Header& header, const Read& read) {
  if (header.fields.empty()) {
    text.fail("expected FIELDS before this line");
  }
  for (Field& field : header.fields) {
    read(field);
  }
  text.expect_line_end();
}

std::int64_t read_between(TextCursor& text, std::int64_t least, std::int64_t most,
                          const char* what) {
  const std::int64_t value = text.integer(what);
  if (value < least || value > most) {
    text.fail(std::string("expected ") + what + " from " + std::to_string(least) + " to " +
              std::to_string(most) + ", got " + std::to_string(value));
  }
  return value;
}

void read_size(TextCursor& text, Field& field) {
  field.size = read_between(text, 1, 8, "a size in bytes");
  if (field.size != 1 && field.size != 2 && field.size != 4 && field.size != 8) {
    text.fail("expected a size of 1, 2, 4 or 8 bytes, got " + std::to_string(field.size));
  }
}

void read_type(TextCursor& text, Field& field) {
  const std::string_view word = text.word();
  if (word != "F" && word != "I" && word != "U") {
    text.fail("expected a type F, I or U for each field, got " + detail::quoted(word));
  }
  field.type = word[0];
}

void read_data(TextCursor& text, Header& header) {
  const std::string_view word = text.word();
  if (word == "ascii") {
    header.data = Data::ascii;
  } else if (word == "binary") {
    header.data = Data::binary;
  } else if (word == "binary_compressed") {
    header.data = Data::compressed;
  } else {
    text.fail("expected ascii, binary or binary_compressed, got " + detail::quoted(word));
  }
}

void find_coordinates(const TextCursor& text, Header& header) {
  constexpr std::array<std::string_view, 3> kNames = {"x", "y", "z"};
  for (std::size_t k = 0; k < 3; ++k) {
    std::size_t found = 0;
    for (std::size_t i = 0; i < header.fields.size(); ++i) {
      if (header.fields[i].name == kNames[k]) {
        header.coordinates[k] = i;
        ++found;
      }
    }
    const Field* field = found == 1 ? &header.fields[header.coordinates[k]] : nullptr;
    if (field == nullptr || field->count != 1) {
      text.fail("expected one field " + std::string(kNames[k]) + " of count 1");
    }
    if (field->type == 'F' && field->size < 4) {
      text.fail("expected a floating-point field of 4 or 8 bytes");
    }
  }
}

void find_count(const TextCursor& text, Header& header) {
  constexpr std::int64_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (header.width) {
    // At most 2^32 each: the product of the two fits.
    const std::int64_t product = *header.width * header.height.value_or(1);
    if (header.points && *header.points != product) {
      text.fail("expected POINTS to be WIDTH times HEIGHT, " + std::to_string(product) + ", got " +
                std::to_string(*header.points));
    }
    header.points = product;
  }
  if (!header.points || *header.points < 1 || *header.points > kMost) {
    text.fail("expected POINTS, or WIDTH and HEIGHT, of at least one point and below 2^32");
  }
}

/// Reads the header, up to the end of the line DATA.
Header read_header(TextCursor& text) {
  constexpr std::int64_t kMostPoints = std::int64_t{1} << 31;
  Header header;
  while (text.find_line()) {
    const std::string_view keyword = text.word();
    if (keyword == "FIELDS") {
      read_fields(text, header);
    } else if (keyword == "SIZE") {
      read_for_each_field(text, header, [&](Field& field) { read_size(text, field); });
    } else if (keyword == "TYPE") {
      read_for_each_field(text, header, [&](Field& field) { read_type(text, field); });
    } else if (keyword == "COUNT") {
      read_for_each_field(text, header, [&](Field& field) {
        field.count = read_between(text, 0, 1 << 20, "a count");
      });
    } else if (keyword == "WIDTH") {
      header.width = read_between(text, 0, kMostPoints, "a width");
    } else if (keyword == "HEIGHT") {
      header.height = read_between(text, 0, kMostPoints, "a height");
    } else if (keyword == "POINTS") {
      header.points = read_between(text, 0, kMostPoints, "a number of points");
    } else if (keyword == "DATA") {
      read_data(text, header);
      find_coordinates(text, header);
      find_count(text, header);
      text.skip_line();
      return header;
    } else if (keyword != "VERSION" && keyword != "VIEWPOINT") {
      text.fail(
          "expected VERSION, FIELDS, SIZE, TYPE, COUNT, WIDTH, HEIGHT, VIEWPOINT, POINTS or "
          "DATA, got " +
          detail::quoted(keyword));
    }
    text.skip_line();
  }
  text.fail("expected a line DATA in the header, got the end of the file");
}

/// Whether a point is missing: it is NaN.
bool is_missing(const Vector3d& p) { return p.hasNaN(); }

bool is_nan(std::string_view word) {
  return word == "nan" || word == "NaN" || word == "NAN" || word == "-nan";
}

double ascii_coordinate(TextCursor& text) {
  TextCursor ahead = text;
  if (is_nan(ahead.word())) {
    text.word();
    return std::numeric_limits<double>::quiet_NaN();
  }
  return text.number("a finite coordinate");
}

Vector3d ascii_point(TextCursor& text, const Header& header) {
  Vector3d p;
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    bool is_coordinate = false;
    for (int k = 0; k < 3; ++k) {
      if (header.coordinates[static_cast<std::size_t>(k)] == i) {
        p[k] = ascii_coordinate(text);
        is_coordinate = true;
      }
    }
    for (std::int64_t k = 0; !is_coordinate && k < header.fields[i].count; ++k) {
      if (text.word().empty()) {
        text.fail_at_word("a number");
      }
    }
  }
  text.expect_line_end();
  return p;
}

std::vector<Vector3d> read_ascii(TextCursor& text, const Header& header) {
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < header.count(); ++i) {
    if (!text.find_line()) {
      text.fail("expected point " + std::to_string(i + 1) + " of " +
                std::to_string(header.count()) + ", got the end of the file");
    }
    const Vector3d p = ascii_point(text, header);
    if (!is_missing(p)) {
      points.push_back(p);
    }
  }
  if (text.find_line()) {
    text.fail_at_word("the end of the file after the last point");
  }
  return points;
}

double integer(ByteCursor& bytes, const Field& field) {
  const char* what = "a coordinate";
  const bool is_signed = field.type == 'I';
  switch (field.size) {
    case 1:
      return is_signed ? bytes.read<std::int8_t>(what) : bytes.read<std::uint8_t>(what);
    case 2:
      return is_signed ? bytes.read<std::int16_t>(what) : bytes.read<std::uint16_t>(what);
    case 4:
      return is_signed ? bytes.read<std::int32_t>(what) : bytes.read<std::uint32_t>(what);
    default:
      return is_signed ? static_cast<double>(bytes.read<std::int64_t>(what))
                       : static_cast<double>(bytes.read<std::uint64_t>(what));
  }
}

double coordinate(ByteCursor& bytes, const Field& field) {
  if (field.type != 'F') {
    return integer(bytes, field);
  }
  const double value = field.size == 4 ? static_cast<double>(bytes.read<float>("a coordinate"))
                                       : bytes.read<double>("a coordinate");
  if (std::isinf(value)) {
    bytes.fail("expected a finite coordinate before this byte");
  }
  return value;
}

/// The place of the values of one coordinate: of the first point, and from point to point.
struct Column {
  const Field* field = nullptr;
  std::size_t first = 0;   ///< [byte]
  std::size_t stride = 0;  ///< [byte]
};

/// Finds the columns, where points stand one after another, or fields do.
std::array<Column, 3> find_columns(const Header& header, bool by_fields) {
  std::array<Column, 3> columns;
  std::size_t offset = 0;
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    const Field& field = header.fields[i];
    for (std::size_t k = 0; k < 3; ++k) {
      if (header.coordinates[k] == i) {
        columns[k] = {&field, offset, by_fields ? field.bytes() : header.point_bytes()};
      }
    }
    offset += by_fields ? field.bytes() * header.count() : field.bytes();
  }
  return columns;
}

std::vector<Vector3d> read_columns(std::string_view data, const std::string& source,
                                   std::size_t first_offset, const Header& header, bool by_fields) {
  const std::array<Column, 3> columns = find_columns(header, by_fields);
  std::vector<Vector3d> points;
  points.reserve(header.count());
  for (std::size_t i = 0; i < header.count(); ++i) {
    Vector3d p;
    for (int k = 0; k < 3; ++k) {
      const Column& column = columns[static_cast<std::size_t>(k)];
      const std::size_t place = column.first + i * column.stride;
      ByteCursor bytes(data.substr(place), source, false, first_offset + place);
      p[k] = coordinate(bytes, *column.field);
    }
    if (!is_missing(p)) {
      points.push_back(p);
    }
  }
  return points;
}

/// [byte]  Computes the size of all points; refuses a size that does not fit a file.
std::size_t total_bytes(const Header& header, const ByteCursor& bytes) {
  const std::size_t of_point = header.point_bytes();
  constexpr std::size_t kMost = std::size_t{1} << 40;
  if (of_point > kMost / header.count()) {
    bytes.fail("expected points of at most 2^40 bytes");
  }
  return of_point * header.count();
}

std::vector<Vector3d> read_binary(std::string_view data, const std::string& source,
                                  std::size_t begin, const Header& header) {
  const ByteCursor bytes(data.substr(begin), source, false, begin);
  const std::size_t expected = total_bytes(header, bytes);
  if (bytes.remaining() < expected) {
    bytes.fail("expected " + std::to_string(expected) + " bytes of points from here on, got " +
               std::to_string(bytes.remaining()));
  }
  return read_columns(bytes.rest(), source, begin, header, false);
}

std::vector<Vector3d> read_compressed(std::string_view data, const std::string& source,
                                      std::size_t begin, const Header& header) {
  ByteCursor bytes(data.substr(begin), source, false, begin);
  const std::size_t expected = total_bytes(header, bytes);
  const auto compressed = bytes.read<std::uint32_t>("the compressed size");
  const auto expanded = bytes.read<std::uint32_t>("the uncompressed size");
  if (expanded != expected || compressed > bytes.remaining()) {
    bytes.fail("expected " + std::to_string(expected) +
               " bytes of points, compressed into at most " + std::to_string(bytes.remaining()));
  }
  const std::optional<std::string> points =
      detail::expand_lzf(bytes.rest().substr(0, compressed), expected);
  if (!points) {
    bytes.fail("expected " + std::to_string(expected) + " bytes of points compressed by LZF");
  }
  return read_columns(*points, source, begin, header, true);
}

}  // namespace

std::vector<Vector3d> parse_pcd(std::string_view data, const std::string& source) {
  TextCursor text(data, source, {.comments = true, .continuation = false});
  const Header header = read_header(text);
  const std::size_t begin = data.size() - text.remaining();
  std::vector<Vector3d> points = header.data == Data::ascii ? read_ascii(text, header)
                                 : header.data == Data::binary
                                     ? read_binary(data, source, begin, header)
                                     : read_compressed(data, source, begin, header);
  if (points.empty()) {
    throw ParseError(source, "expected at least one point, found none that is not NaN");
  }
  return points;
}

}  // namespace firstcontact
