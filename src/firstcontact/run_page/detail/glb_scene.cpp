#include <firstcontact/run_page/detail/glb_scene.h>

#include <array>

#include <firstcontact/run_page/detail/drawn_mesh.h>

namespace firstcontact::detail {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kPoints = 0;  // Modes of a primitive in glTF.
constexpr int kTriangles = 4;

/// A material of glTF.
///
/// @param rgb  linear
Json material(const char* name, const std::array<double, 3>& rgb) {
  return {{"name", name},
          {"doubleSided", true},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", Json::array({rgb[0], rgb[1], rgb[2], 1.0})},
            {"metallicFactor", 0.1},
            {"roughnessFactor", 0.6}}}};
}

Json vector_json(const Eigen::Vector3d& v) {
  return Json::array(
      {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())});
}

Json rotation_json(const Eigen::Quaterniond& q) {
  return Json::array({static_cast<float>(q.x()), static_cast<float>(q.y()),
                      static_cast<float>(q.z()), static_cast<float>(q.w())});
}

}  // namespace

const GlbScene::KnownShape& GlbScene::known(const Shape& shape) {
  const ShapeKey key(&shape.mesh(), shape.radius());
  const auto found = shapes_.find(key);
  if (found != shapes_.end()) {
    return found->second;
  }
  const DrawnMesh drawn = drawn_mesh(shape);
  Json primitive{
      {"attributes", {{"POSITION", writer_.add(drawn.vertices, 3, GlbWriter::Target::vertices)}}}};
  if (!drawn.corners.empty()) {
    primitive["indices"] = writer_.add(drawn.corners);
  }
  primitive["mode"] = drawn.corners.empty() ? kPoints : kTriangles;
  return shapes_.emplace(key, KnownShape{std::move(primitive), drawn.origin}).first->second;
}

std::size_t GlbScene::mesh_of(const Shape& shape, GlbLook look) {
  const ShapeKey key(&shape.mesh(), shape.radius());
  const auto [place, is_new] = mesh_numbers_.try_emplace({key, look}, meshes_.size());
  if (is_new) {
    Json primitive = known(shape).primitive;
    primitive["material"] = static_cast<int>(look);
    meshes_.push_back({{"primitives", Json::array({std::move(primitive)})}});
  }
  return place->second;
}

void GlbScene::add(const GlbBody& body, const Shape& shape) {
  const std::size_t node = nodes_.size();
  nodes_.push_back({{"name", body.name},
                    {"translation", vector_json(body.keys.front().place)},
                    {"rotation", rotation_json(body.keys.front().R_WB)},
                    {"children", Json::array({node + 1})}});
  nodes_.push_back({{"mesh", mesh_of(shape, body.look)},
                    {"translation", vector_json(known(shape).origin - body.p_BC)}});
  bodies_.push_back(node);
  if (body.keys.size() > 1) {
    add_motion(node, body.keys);
  }
}

void GlbScene::add_motion(std::size_t node, const std::vector<GlbKey>& keys) {
  std::vector<float> times;
  std::vector<float> places;
  std::vector<float> rotations;  // Components x, y, z, w of each.
  for (const GlbKey& key : keys) {
    times.push_back(key.time);
    for (const double x : key.place) {
      places.push_back(static_cast<float>(x));
    }
    for (const double x : key.R_WB.coeffs()) {
      rotations.push_back(static_cast<float>(x));
    }
  }
  const std::size_t input = writer_.add(times, 1, GlbWriter::Target::none);
  const auto add_channel = [&](const char* path, std::size_t output) {
    channels_.push_back(
        {{"sampler", samplers_.size()}, {"target", {{"node", node}, {"path", path}}}});
    samplers_.push_back({{"input", input}, {"interpolation", "LINEAR"}, {"output", output}});
  };
  add_channel("translation", writer_.add(places, 3, GlbWriter::Target::none));
  add_channel("rotation", writer_.add(rotations, 4, GlbWriter::Target::none));
}

std::string GlbScene::write(const Eigen::Vector3d& up) {
  const std::size_t world = nodes_.size();
  nodes_.push_back({{"name", "world"},
                    {"rotation", rotation_json(Eigen::Quaterniond::FromTwoVectors(
                                     up, Eigen::Vector3d::UnitY()))},
                    {"children", std::move(bodies_)}});
  Json document{{"scene", 0}};
  document["scenes"] = Json::array({{{"nodes", Json::array({world})}}});
  document["nodes"] = std::move(nodes_);
  document["meshes"] = std::move(meshes_);
  // In the order of GlbLook.
  document["materials"] =
      Json::array({material("free", {0.13, 0.35, 0.72}), material("scripted", {0.80, 0.42, 0.08}),
                   material("resting", {0.50, 0.50, 0.50})});
  if (!channels_.empty()) {
    document["animations"] = Json::array({{{"name", "run"},
                                           {"channels", std::move(channels_)},
                                           {"samplers", std::move(samplers_)}}});
  }
  return writer_.write(std::move(document));
}

}  // namespace firstcontact::detail
