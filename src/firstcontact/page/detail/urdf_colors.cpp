#include <firstcontact/page/detail/urdf_colors.h>

#include <algorithm>

#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/read_file.h>
#include <firstcontact/text/xml_reader.h>

namespace firstcontact::detail {
namespace {

using Color = std::optional<Eigen::Vector3d>;

class ColorReader {
 public:
  explicit ColorReader(std::string_view text) : xml_(text, "URDF") {}

  [[nodiscard]] UrdfColors read() {
    const XmlElement& root = xml_.root("robot");
    for (const XmlElement* material : xml_.children(root, "material")) {
      define(*material);
    }
    // A material that a visual defines serves all others by its name, also earlier ones.
    for (const XmlElement* link : xml_.children(root, "link")) {
      for (const XmlElement* visual : xml_.children(*link, "visual")) {
        for (const XmlElement* material : xml_.children(*visual, "material")) {
          define(*material);
        }
      }
    }
    UrdfColors colors;
    for (const XmlElement* link : xml_.children(root, "link")) {
      const char* name = link->Attribute("name");
      std::vector<Color>& of_link = colors[name == nullptr ? "" : name];
      for (const XmlElement* visual : xml_.children(*link, "visual")) {
        of_link.push_back(color_of_visual(*visual));
      }
    }
    return colors;
  }

 private:
  [[nodiscard]] Color color_of(const XmlElement& material) const {
    for (const XmlElement* color : xml_.children(material, "color")) {
      try {
        const std::vector<double> rgba = xml_.numbers(*color, "rgba");
        if (rgba.size() >= 3) {
          return Eigen::Vector3d(rgba[0], rgba[1], rgba[2]).cwiseMax(0.0).cwiseMin(1.0);
        }
      } catch (const ParseError&) {  // The visual then has no colour.
      }
    }
    return std::nullopt;
  }

  void define(const XmlElement& material) {
    const char* name = material.Attribute("name");
    if (const Color color = color_of(material); color && name != nullptr) {
      by_name_.try_emplace(name, *color);
    }
  }

  [[nodiscard]] Color color_of_visual(const XmlElement& visual) const {
    for (const XmlElement* material : xml_.children(visual, "material")) {
      if (const Color own = color_of(*material)) {
        return own;
      }
      const char* name = material->Attribute("name");
      const auto found = by_name_.find(name == nullptr ? "" : name);
      return found == by_name_.end() ? std::nullopt : Color(found->second);
    }
    return std::nullopt;
  }

  XmlReader xml_;
  std::map<std::string, Eigen::Vector3d> by_name_;
};

}  // namespace

UrdfColors parse_urdf_colors(std::string_view text) {
  try {
    return ColorReader(text).read();
  } catch (const ParseError&) {
    return {};
  }
}

UrdfColors read_urdf_colors(const std::filesystem::path& path) {
  try {
    return parse_urdf_colors(read_file(path, "a URDF file"));
  } catch (const ParseError&) {
    return {};
  }
}

}  // namespace firstcontact::detail
