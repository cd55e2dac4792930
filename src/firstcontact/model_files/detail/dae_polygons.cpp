#include <firstcontact/model_files/detail/dae_polygons.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <firstcontact/text/text_cursor.h>

namespace firstcontact::detail {
namespace {

constexpr const char* kDrawing = "a drawing: it bounds no body";

/// The position of the vertex among the interleaved indices.
struct IndexLayout {
  std::uint64_t vertex = 0;
  std::uint64_t stride = 1;  ///< Indices of each corner.
};

/// Finds the one input that places corners.
const XmlElement& vertex_input(const DaeDocument& document, const XmlElement* vertices,
                               const XmlElement& primitive,
                               const std::vector<const XmlElement*>& inputs) {
  const XmlElement* found = nullptr;
  for (const XmlElement* input : inputs) {
    const char* const value = input->Attribute("semantic");
    const std::string_view semantic = value == nullptr ? "" : value;
    if (semantic == "POSITION") {
      document.fail(*input, "expected POSITION in <vertices>, and VERTEX here");
    }
    if (semantic == "VERTEX" && found != nullptr) {
      document.fail(*input, "a second input VERTEX; keep one");
    }
    found = semantic == "VERTEX" ? input : found;
  }
  if (found == nullptr) {
    document.fail(primitive, "expected an <input semantic=\"VERTEX\"> inside");
  }
  if (vertices == nullptr || !document.names(*found, "source", *vertices)) {
    document.fail(*found, "expected a reference to the <vertices> of its own mesh");
  }
  return *found;
}

IndexLayout read_layout(const DaeDocument& document, const XmlElement* vertices,
                        const XmlElement& primitive) {
  const auto inputs = document.xml().children(primitive, "input");
  const XmlElement& vertex = vertex_input(document, vertices, primitive, inputs);
  const auto missing = inputs.size() == 1 ? std::optional<std::uint64_t>(0) : std::nullopt;
  IndexLayout layout;
  for (const XmlElement* input : inputs) {
    document.check_attributes(*input, {"semantic", "source", "offset", "set"});
    const std::uint64_t offset = document.xml().whole_number(*input, "offset", missing);
    if (offset >= std::numeric_limits<std::uint32_t>::max()) {
      document.fail(*input, "expected an offset below 2^32 - 1");
    }
    layout.stride = std::max(layout.stride, offset + 1);
    layout.vertex = input == &vertex ? offset : layout.vertex;
  }
  return layout;
}

/// Appends the vertices of a <p> and returns their number.
std::size_t append_corners(const DaeDocument& document, const XmlElement& list,
                           const IndexLayout& layout, std::vector<std::uint32_t>& corners) {
  const XmlText text = document.xml().content(list);
  TextCursor cursor(text.view(), document.xml().source(), {}, text.line());
  const std::size_t before = corners.size();
  std::uint64_t at = 0;  // Position in the corner.
  while (cursor.find_line()) {
    const std::int64_t index = cursor.integer("an index, a whole number,");
    if (at == layout.vertex) {
      if (index < 0 || index >= std::numeric_limits<std::uint32_t>::max()) {
        cursor.fail("expected an index of a vertex >= 0, got " + std::to_string(index));
      }
      corners.push_back(static_cast<std::uint32_t>(index));
    }
    at = at + 1 == layout.stride ? 0 : at + 1;
  }
  if (at != 0) {
    document.fail(list, "expected " + std::to_string(layout.stride) +
                            " indices for each corner, and no rest");
  }
  return corners.size() - before;
}

bool holds_words(const DaeDocument& document, const XmlElement& element) {
  return document.xml().content(element).view().find_first_not_of(" \t\r\n") !=
         std::string_view::npos;
}

/// Reads one primitive element.
class PrimitiveReader {
 public:
  PrimitiveReader(const DaeDocument& document, const XmlElement* vertices,
                  const XmlElement& primitive)
      : document_(document), vertices_(vertices), primitive_(primitive) {}

  /// Reads the primitive; nothing for an empty one.
  [[nodiscard]] std::optional<DaePolygons> read() {
    result_.element = &primitive_;
    document_.check_children(primitive_, {"input", "p", "ph", "vcount"});
    const auto lists = document_.xml().children(primitive_, "p");
    const bool empty = primitive_.FirstChildElement("ph") == nullptr &&
                       std::none_of(lists.begin(), lists.end(), [&](const XmlElement* list) {
                         return holds_words(document_, *list);
                       });
    if (empty) {
      expect_none();
      return std::nullopt;
    }
    layout_ = read_layout(document_, vertices_, primitive_);
    read_lists(lists);
    return result_.corners.empty() ? std::nullopt : std::optional(std::move(result_));
  }

 private:
  /// Refuses counts in a primitive without indices.
  void expect_none() const {
    if (document_.xml().whole_number(primitive_, "count", 0) != 0) {
      expect_count(0);
    }
    const XmlElement* const counts = document_.xml().child(primitive_, "vcount");
    if (counts != nullptr && document_.xml().content(*counts).view().find_first_of("123456789") !=
                                 std::string_view::npos) {
      document_.fail(*counts, "expected no corners without indices in <p>, got some");
    }
  }

  void expect_count(std::uint64_t found) const {
    const std::uint64_t count = document_.xml().whole_number(primitive_, "count");
    if (count != found) {
      document_.refuse(
          primitive_,
          "expected " + std::to_string(count) + " as its count says, got " + std::to_string(found),
          "the count of a primitive");
    }
  }

  void read_lists(const std::vector<const XmlElement*>& lists) {
    const std::string_view kind = primitive_.Name();
    if (kind == "triangles") {
      read_triangles(lists);
    } else if (kind == "polylist") {
      read_polylist(lists);
    } else if (kind == "polygons") {
      read_polygons();
    } else {
      read_strips(lists, kind == "tristrips");
    }
  }

  std::size_t append(const XmlElement& list) {
    return append_corners(document_, list, layout_, result_.corners);
  }

  void append_all(const std::vector<const XmlElement*>& lists) {
    for (const XmlElement* list : lists) {
      append(*list);
    }
  }

  void read_triangles(const std::vector<const XmlElement*>& lists) {
    append_all(lists);
    if (result_.corners.size() % 3 != 0) {
      document_.fail(primitive_, "expected three corners for each triangle, and no rest");
    }
    expect_count(result_.corners.size() / 3);
  }

  void read_polylist(const std::vector<const XmlElement*>& lists) {
    append_all(lists);
    const XmlElement& counts = document_.xml().required_child(primitive_, "vcount");
    const XmlText text = document_.xml().content(counts);
    TextCursor cursor(text.view(), document_.xml().source(), {}, text.line());
    std::uint64_t total = 0;
    std::vector<DaeRing> rings;
    while (cursor.find_line()) {
      const std::int64_t size = cursor.integer("a number of corners");
      total += static_cast<std::uint64_t>(std::max<std::int64_t>(size, 0));
      if (size < 0 || total > result_.corners.size()) {
        cursor.fail("expected numbers >= 0 of " + std::to_string(result_.corners.size()) +
                    " corners in all, got more");
      }
      rings.push_back({static_cast<std::uint32_t>(size), false});
    }
    if (total != result_.corners.size()) {
      document_.fail(counts, "expected numbers of " + std::to_string(result_.corners.size()) +
                                 " corners in all, got " + std::to_string(total));
    }
    expect_count(rings.size());
    keep_polygons(rings);
  }

  void read_polygons() {
    std::vector<DaeRing> rings;
    std::uint64_t count = 0;
    for (const XmlElement* child = primitive_.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      const std::string_view name = child->Name();
      if (name == "p") {
        rings.push_back({static_cast<std::uint32_t>(append(*child)), false});
        ++count;
      } else if (name == "ph") {
        append_holed(*child, rings);
        ++count;
      }
    }
    expect_count(count);
    keep_polygons(rings);
  }

  void append_holed(const XmlElement& polygon, std::vector<DaeRing>& rings) {
    document_.check_children(polygon, {"p", "h"});
    const XmlElement& outer = document_.xml().required_child(polygon, "p");
    const std::size_t corners = append(outer);
    if (corners < 3) {
      document_.fail(outer, "expected at least three corners around holes");
    }
    rings.push_back({static_cast<std::uint32_t>(corners), false});
    for (const XmlElement* hole : document_.xml().children(polygon, "h")) {
      rings.push_back({static_cast<std::uint32_t>(append(*hole)), true});
    }
  }

  /// Leaves out polygons of less than three corners.
  void keep_polygons(const std::vector<DaeRing>& rings) {
    auto from = result_.corners.begin();
    auto to = from;
    for (const DaeRing& ring : rings) {
      if (ring.size < 3) {
        document_.log().leave_out(
            "polygons of " + std::to_string(ring.size) + (ring.size == 1 ? " corner" : " corners"),
            kDrawing);
      } else {
        to = std::copy_n(from, ring.size, to);
        result_.rings.push_back(ring);
      }
      from += ring.size;
    }
    result_.corners.erase(to, result_.corners.end());
  }

  void read_strips(const std::vector<const XmlElement*>& lists, bool strips) {
    for (const XmlElement* list : lists) {
      std::vector<std::uint32_t> row;
      append_corners(document_, *list, layout_, row);
      if (row.size() < 3) {
        document_.log().leave_out("strips and fans of less than 3 corners", kDrawing);
      }
      for (std::size_t i = 2; i < row.size(); ++i) {
        const bool odd = strips && i % 2 == 1;  // Every second triangle of a strip is turned.
        const std::uint32_t first = strips ? row[i - 2] : row[0];
        result_.corners.insert(result_.corners.end(),
                               {odd ? row[i - 1] : first, odd ? first : row[i - 1], row[i]});
      }
    }
    expect_count(lists.size());
  }

  const DaeDocument& document_;
  const XmlElement* vertices_;  ///< The <vertices> of the mesh; null if it has none.
  const XmlElement& primitive_;
  IndexLayout layout_;
  DaePolygons result_;
};

}  // namespace

std::vector<DaePolygons> read_dae_polygons(const DaeDocument& document, const XmlElement& mesh) {
  document.check_children(
      mesh, {"source", "vertices", "triangles", "polylist", "polygons", "tristrips", "trifans"},
      {{"lines", kDrawing}, {"linestrips", kDrawing}});
  const XmlElement* const vertices = mesh.FirstChildElement("vertices");
  std::vector<DaePolygons> all;
  for (const XmlElement* child = mesh.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    const std::string_view name = child->Name();
    if (name == "triangles" || name == "polylist" || name == "polygons" || name == "tristrips" ||
        name == "trifans") {
      if (auto polygons = PrimitiveReader(document, vertices, *child).read()) {
        all.push_back(std::move(*polygons));
      }
    }
  }
  return all;
}

}  // namespace firstcontact::detail
