#include <firstcontact/run_page/write_run_page.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

#include <firstcontact/page/write_page.h>
#include <firstcontact/record/write_run.h>
#include <firstcontact/scene/links_as_bodies.h>

namespace firstcontact {
namespace {

void add_single(PageNumbers& row, const Eigen::Vector3d& v) {
  for (const double coordinate : v) {
    row.add(static_cast<float>(coordinate));
  }
}

void add_single(PageNumbers& row, const Eigen::Quaterniond& q) {
  for (const double coordinate : {q.w(), q.x(), q.y(), q.z()}) {
    row.add(static_cast<float>(coordinate));
  }
}

}  // namespace

RunPage::RunPage(const RunHeader& header)
    : header_(header),
      centres_of_mass_(header.centres_of_mass),
      polylines_(header.centres_of_mass.size()) {}

void RunPage::add(const RunStep& step) {
  for (const RunBody& moved : step.bodies) {
    add(moved);
  }
  for (const RunContact& contact : step.contacts) {
    add(contact);
  }
  for (const RunDevice& device : step.devices) {
    add(device);
  }
  contacts_until_.add(contact_count_, 4);
  ++step_count_;
  // The step leaves out what polylines, contacts and devices hold.
  RunStep rest = step;
  rest.bodies.clear();
  rest.contacts.clear();
  rest.devices.clear();
  steps_ += (steps_.empty() ? "" : ",") + write_run_step(rest);
  time_ = step.time;
}

void RunPage::add_place(Polyline& polyline, std::size_t body, double time, const Pose& X_WB) const {
  polyline.times.add(time);
  polyline.places.add(Eigen::Vector3d(X_WB.position + X_WB.rotation * centres_of_mass_[body]));
  add_single(polyline.rotations, X_WB.rotation);
}

void RunPage::begin_piece(std::size_t body, double time, const Pose& X_WB,
                          const Eigen::Vector3d& turn) {
  add_place(polylines_[body], body, time, X_WB);
  add_single(polylines_[body].turns, turn);
}

void RunPage::add(const RunBody& moved) {
  Polyline& polyline = polylines_[moved.body];
  double from = time_;
  if (polyline.times.size() > 0 && polyline.end < from) {
    // The body is not in the last steps, as it stayed in place.
    begin_piece(moved.body, polyline.end, polyline.X_WB, Eigen::Vector3d::Zero());
  }
  for (const RunPiece& piece : moved.pieces) {
    begin_piece(moved.body, from, piece.X_WB, piece.rotation_vector);
    from = time_ + piece.to;
  }
  polyline.end = from;
  polyline.X_WB = moved.X_WB;
}

void RunPage::add(const RunContact& contact) {
  for (const std::size_t body : contact.bodies) {
    contact_bodies_.add(body, 4);
  }
  points_.add(contact.point);
  add_single(impulses_, contact.impulse);
  distances_.add(static_cast<float>(contact.distance));
  ++contact_count_;
}

void RunPage::add(const RunDevice& device) {
  auto rows = std::ranges::find(devices_, device.body, &DeviceRows::body);
  if (rows == devices_.end()) {
    rows = devices_.emplace(rows);
    rows->body = device.body;
  }
  rows->steps.add(step_count_, 4);
  rows->positions.add(device.X_WB.position);
  add_single(rows->rotations, device.X_WB.rotation);
  add_single(rows->forces, device.force);
  add_single(rows->torques, device.torque);
  rows->links.resize(device.links.size());
  for (std::size_t k = 0; k < device.links.size(); ++k) {
    rows->links[k].body = device.links[k].body;
    rows->links[k].positions.add(device.links[k].X_WB.position);
    add_single(rows->links[k].rotations, device.links[k].X_WB.rotation);
  }
}

/// The header of a page. Links are bodies there, and the page has their meshes elsewhere.
std::string RunPage::header_json(const Scene& linked) const {
  RunHeader header = header_;
  header.scene = linked;
  header.scene.simulation = header_.scene.simulation;
  header.scene.simulation->pairs = linked.simulation->pairs;
  header.scene.simulation->ties = linked.simulation->ties;
  for (std::size_t b = header_.scene.bodies.size(); b < header.scene.bodies.size(); ++b) {
    header.scene.bodies[b].shape.source = Mesh{};
  }
  return write_run_header(header);
}

std::string RunPage::polylines_json() const {
  nlohmann::ordered_json polylines = nlohmann::ordered_json::array();
  for (std::size_t body = 0; body < polylines_.size(); ++body) {
    Polyline polyline = polylines_[body];
    if (polyline.times.size() > 0) {
      add_place(polyline, body, polyline.end, polyline.X_WB);
      polylines.push_back({{"body", body},
                           {"times", polyline.times.base64()},
                           {"places", polyline.places.base64()},
                           {"rotations", polyline.rotations.base64()},
                           {"turns", polyline.turns.base64()}});
    }
  }
  return polylines.dump();
}

std::string RunPage::contacts_json() const {
  return nlohmann::ordered_json{{"until", contacts_until_.base64()},
                                {"bodies", contact_bodies_.base64()},
                                {"points", points_.base64()},
                                {"impulses", impulses_.base64()},
                                {"distances", distances_.base64()}}
      .dump();
}

std::string RunPage::devices_json() const {
  nlohmann::ordered_json devices = nlohmann::ordered_json::array();
  for (const DeviceRows& rows : devices_) {
    nlohmann::ordered_json links = nlohmann::ordered_json::array();
    for (const DeviceLinkRows& link : rows.links) {
      links.push_back({{"body", link.body},
                       {"positions", link.positions.base64()},
                       {"rotations", link.rotations.base64()}});
    }
    devices.push_back({{"body", rows.body},
                       {"steps", rows.steps.base64()},
                       {"positions", rows.positions.base64()},
                       {"rotations", rows.rotations.base64()},
                       {"forces", rows.forces.base64()},
                       {"torques", rows.torques.base64()}});
    if (!links.empty()) {
      devices.back()["links"] = std::move(links);
    }
  }
  return devices.dump();
}

std::string RunPage::write(std::string_view page_template, const LoadedScene& loaded) const {
  if (!(time_ > 0.0)) {
    throw std::invalid_argument("expected a run of some time: there is nothing to play");
  }
  const LoadedScene linked = links_as_bodies(loaded).loaded;
  const std::string run = "{\"header\":" + header_json(linked.scene) +
                          ",\"links_from\":" + std::to_string(header_.scene.bodies.size()) +
                          ",\"steps\":[" + steps_ + "],\"ways\":" + polylines_json() +
                          ",\"contacts\":" + contacts_json() +
                          (devices_.empty() ? "" : ",\"devices\":" + devices_json()) + "}";
  return write_page(page_template, linked, {.name = "run", .json = run});
}

}  // namespace firstcontact
