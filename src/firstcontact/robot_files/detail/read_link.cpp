#include <firstcontact/robot_files/detail/read_link.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include <firstcontact/robot_files/detail/mesh_uri.h>
#include <firstcontact/robot_files/link_shape.h>
#include <firstcontact/text/brief_list.h>
#include <firstcontact/text/parse_error.h>

namespace firstcontact::detail {
namespace {

/// Whether the <visual> geometry of a link can touch.
bool visual_touches(RobotSurface surface, bool has_collision) {
  return surface == RobotSurface::visual ||
         (surface == RobotSurface::collision_or_visual && !has_collision);
}

bool is_capsule(std::string_view kind) { return kind == "capsule" || kind == "drake:capsule"; }

bool holds(const std::vector<std::string_view>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

Link LinkReader::read(const XmlElement& element, std::size_t index) {
  const XmlReader& xml = context_.xml;
  context_.names.check(element, urdf_names().link);
  Link link;
  context_.attempt([&] { link.name = xml.text(element, "name"); });
  const bool has_collision = element.FirstChildElement("collision") != nullptr;
  const LoadShapes shapes = context_.options.shapes;
  const bool takes_visual = visual_touches(context_.options.surface, has_collision);
  const bool wants_visual =
      shapes == LoadShapes::all || (shapes == LoadShapes::collision && takes_visual);
  const bool wants_collision =
      shapes == LoadShapes::all || (shapes == LoadShapes::collision && !takes_visual);
  link.visual = geometries(element, true, wants_visual, index);
  link.collision = geometries(element, false, wants_collision, index);
  context_.attempt([&] {
    if (const XmlElement* origin = xml.child(element, "origin")) {
      context_.names.check(*origin, urdf_names().origin);
      context_.pass_over_pose(*origin, "<origin> right inside of a <link>", pose_of(*origin, xml));
    }
  });
  if (const XmlElement* inertial = element.FirstChildElement("inertial")) {
    link.inertia = read_inertia(element, *inertial, context_);
  }
  return link;
}

std::vector<LinkGeometry> LinkReader::geometries(const XmlElement& link, bool is_visual,
                                                 bool is_wanted, std::size_t index) {
  std::vector<LinkGeometry> result;
  for (const XmlElement* piece : context_.xml.children(link, is_visual ? "visual" : "collision")) {
    context_.names.check(*piece, is_visual ? urdf_names().visual : urdf_names().collision);
    context_.attempt([&] {
      std::optional<LinkGeometry> read = geometry(*piece, is_visual, is_wanted);
      if (!read) {
        return;
      }
      if (is_wanted) {
        wanted_.push_back({index, is_visual, result.size(), piece});
      }
      result.push_back(std::move(*read));
    });
  }
  return result;
}

/// Reads a geometry; none for looks in a form that is not read, or for wrong names, which the log
/// reports.
std::optional<LinkGeometry> LinkReader::geometry(const XmlElement& piece, bool is_visual,
                                                 bool is_wanted) const {
  LinkGeometry result;
  if (const char* name = piece.Attribute("name")) {
    result.name = name;
  }
  context_.attempt([&] { result.X_LG = context_.origin(piece); });
  const XmlElement& holder = context_.xml.required_child(piece, "geometry");
  if (is_visual && !is_wanted) {
    const XmlElement* first = holder.FirstChildElement();
    if (first != nullptr && first->NextSiblingElement() == nullptr &&
        misspelt_name(first->Name(), urdf_names().geometry.children).empty()) {
      context_.log.leave_out("<" + std::string(first->Name()) + "> in <visual>", "looks");
      return {};
    }
  }
  const std::size_t errors = context_.log.error_count();
  context_.names.check(holder, urdf_names().geometry);
  if (context_.log.error_count() > errors) {
    return {};
  }
  try {
    result.source = source(*source_element(holder), is_wanted);
  } catch (const ParseError& error) {
    if (!is_visual || is_wanted) {
      throw;
    }
    context_.log.leave_out("<geometry> of a <visual>", std::string("looks; ") + error.what());
    return {};
  }
  if (const auto* mesh = std::get_if<MeshGeometry>(&result.source);
      mesh != nullptr && holder.FirstChildElement("drake:declare_convex") != nullptr) {
    context_.log.warn(context_.xml.error(holder, "Drake takes the convex hull of " +
                                                     mesh->path.filename().string() +
                                                     "; here it is the mesh as it is"),
                      "convex hull");
  }
  return result;
}

/// The one child that holds geometry.
const XmlElement* LinkReader::source_element(const XmlElement& holder) const {
  const XmlElement* found = nullptr;
  for (const XmlElement* child = holder.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    if (!holds(urdf_names().geometry.children.read, child->Name())) {
      continue;  // The names were checked.
    }
    if (found != nullptr) {
      context_.xml.fail(*child, "a second geometry inside " + shown(holder) + "; keep one");
    }
    found = child;
  }
  if (found == nullptr) {
    const XmlElement* other = holder.FirstChildElement();
    context_.xml.fail(holder, "expected one of mesh, box, sphere, cylinder, capsule inside" +
                                  (other != nullptr ? ", got " + shown(*other) : std::string()));
  }
  return found;
}

GeometrySource LinkReader::source(const XmlElement& element, bool is_wanted) const {
  return std::string_view(element.Name()) == "mesh" ? GeometrySource(mesh(element, is_wanted))
                                                    : primitive(element);
}

GeometrySource LinkReader::primitive(const XmlElement& element) const {
  const std::string_view kind = element.Name();
  if (kind == "box") {
    context_.names.check(element, urdf_names().box);
    const Eigen::Vector3d size = context_.xml.vector3(element, "size");
    if (!(size.minCoeff() >= 0.0)) {
      context_.xml.fail(element, "expected three numbers >= 0 in 'size'");
    }
    return BoxGeometry{size};
  }
  if (kind == "sphere") {
    context_.names.check(element, urdf_names().sphere);
    return SphereGeometry{size(element, "radius")};
  }
  context_.names.check(element, urdf_names().round);
  const double radius = size(element, "radius");
  const double length = size(element, "length");
  return is_capsule(kind) ? GeometrySource(CapsuleGeometry{radius, length})
                          : GeometrySource(CylinderGeometry{radius, length});
}

/// Reads a radius or a length.
double LinkReader::size(const XmlElement& element, const char* attribute) const {
  const double size = context_.xml.number(element, attribute);
  if (!(size >= 0.0)) {
    context_.xml.fail(element, "expected '" + std::string(attribute) + "' to be >= 0");
  }
  return size;
}

/// Warns of a flat shape, a segment or a point: it can touch, but may be a mistake.
void LinkReader::warn_of_size_zero(const XmlElement& element, const GeometrySource& source) const {
  const auto* box = std::get_if<BoxGeometry>(&source);
  const auto* sphere = std::get_if<SphereGeometry>(&source);
  const auto* cylinder = std::get_if<CylinderGeometry>(&source);
  const auto* capsule = std::get_if<CapsuleGeometry>(&source);
  const bool is_thin = (box != nullptr && box->size.minCoeff() == 0.0) ||
                       (sphere != nullptr && sphere->radius == 0.0) ||
                       (cylinder != nullptr && cylinder->radius * cylinder->length == 0.0) ||
                       (capsule != nullptr && capsule->radius == 0.0);
  if (is_thin) {
    context_.log.warn(
        context_.xml.error(element, "a size of 0: flat, a segment or a point, and it can touch"),
        "size of 0");
  }
}

MeshGeometry LinkReader::mesh(const XmlElement& element, bool is_wanted) const {
  const XmlReader& xml = context_.xml;
  context_.names.check(element, urdf_names().mesh);
  MeshGeometry mesh;
  try {
    mesh.path = resolve_mesh(xml.text(element, "filename"), context_.source,
                             context_.options.package_roots);
  } catch (const std::invalid_argument& error) {
    xml.fail(element, error.what());
  }
  if (element.Attribute("scale") != nullptr) {
    mesh.scale = xml.vector3(element, "scale");
    if ((mesh.scale.array() == 0.0).any()) {
      xml.fail(element, "expected no 0 in 'scale': it flattens the mesh");
    }
  }
  std::error_code ignored;
  if (is_wanted && !std::filesystem::exists(mesh.path, ignored)) {
    xml.fail(element, "mesh file " + mesh.path.string() + " does not exist");
  }
  if (element.FirstChildElement("drake:declare_convex") != nullptr) {
    context_.log.warn(
        xml.error(element, "Drake takes its convex hull; here it is the mesh as it is"),
        "convex hull");
  }
  return mesh;
}

void LinkReader::make_shapes(std::vector<Link>& links) {
  for (const Wanted& wanted : wanted_) {
    Link& link = links[wanted.link];
    LinkGeometry& geometry = (wanted.is_visual ? link.visual : link.collision)[wanted.geometry];
    warn_of_size_zero(*wanted.element, geometry.source);
    context_.attempt([&] { geometry.shape = shape(*wanted.element, geometry.source); });
  }
  for (Link& link : links) {
    if (visual_touches(context_.options.surface, !link.collision.empty())) {
      link.collision = link.visual;
    }
  }
}

/// Makes a shape. Errors in a mesh file keep their own place; all others get that of the element.
Shape LinkReader::shape(const XmlElement& element, const GeometrySource& source) {
  const auto* mesh = std::get_if<MeshGeometry>(&source);
  try {
    if (mesh == nullptr) {
      return make_shape(source);
    }
    const Eigen::Vector3d& s = mesh->scale;
    const MeshKey key{mesh->path, {s.x(), s.y(), s.z()}};
    const auto known = meshes_.find(key);
    return known != meshes_.end() ? known->second
                                  : meshes_.emplace(key, read_mesh_shape(source)).first->second;
  } catch (const std::invalid_argument& error) {
    context_.xml.fail(element, error.what());
  }
}

/// Reads a mesh, and notes the report of a file that is read for the first time, at any scale.
Shape LinkReader::read_mesh_shape(const GeometrySource& source) {
  ShapeReading reading = read_shape(source, context_.options.reading);
  const auto is_same = [&](const FileReport& file) { return file.path == reading.report->path; };
  if (std::none_of(mesh_files_.begin(), mesh_files_.end(), is_same)) {
    mesh_files_.push_back(std::move(*reading.report));
  }
  return std::move(reading.shape);
}

void LinkReader::warn_of_links_that_cannot_touch(const std::vector<Link>& links) const {
  std::vector<std::string> names;
  bool others_touch = false;
  for (const Link& link : links) {
    others_touch = others_touch || !link.collision.empty();
    if (link.collision.empty() && !link.visual.empty()) {
      names.push_back(link.name);
    }
  }
  if (others_touch && !names.empty()) {
    const bool is_one = names.size() == 1;
    context_.log.warn(ParseError(
        context_.source.string(),
        std::string(is_one ? "link " : "links ") + some_of(names) + (is_one ? " has" : " have") +
            " <visual> and no <collision>: nothing can touch " + (is_one ? "it" : "them") +
            "; surface \"collision_or_visual\" (--visual-where-missing) takes how " +
            (is_one ? "it looks" : "they look")));
  }
}

}  // namespace firstcontact::detail
