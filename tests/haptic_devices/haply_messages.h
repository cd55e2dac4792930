/// @file
/// Messages of the Haply Inverse Service, with the keys that its documentation shows.

#pragma once

#include <string>

namespace firstcontact::test {

/// First message of versions 3.1 to 3.4, with a wired grip.
inline const char* const kInventoryBefore35 = R"({
"inverse3": [{"device_id": "04BA",
  "config": {"type": "inverse3", "device_info": {"minor_version": 1, "major_version": 7, "id": "04BA", "model": 4, "uuid": "2D35"},
    "port": "COM13", "gravity_compensation": {"enabled": true, "scaling_factor": 1}, "handedness": "right", "torque_scaling": {"enabled": true}},
  "state": {"angular_position": {"a0": -69.31704, "a1": 137.62952, "a2": 19.832787},
    "angular_velocity": {"a0": 0, "a1": 0, "a2": 0},
    "body_orientation": {"x": -0.01940918, "y": 0.7026367, "z": 0.00048828125, "w": 0.7113037},
    "cursor_position": {"x": 0.07842738, "y": -0.14836666, "z": 0.14297646},
    "cursor_velocity": {"x": -0.011969013, "y": 0.0012009288, "z": -0.043197}, "mode": "idle"},
  "status": {"calibrated": false, "in_use": false, "power_supply": true, "ready": true, "started": true}}],
"verse_grip": [{"device_id": "61548", "config": {"port": "COM3", "type": "verse_grip"},
  "state": {"button": true, "hall": 0, "orientation": {"x": -0.5019531, "y": 0.8632202, "z": -0.048095703, "w": -0.022338867}},
  "status": {"error": 0, "ready": true}}]})";

/// First message of version 3.5, with a wireless grip.
inline const char* const kInventorySince35 = R"({
"session_id": 7,
"inverse3": [{"device_id": "049D",
  "config": {"type": "inverse3", "port": "COM12", "device_info": {"major_version": 7, "minor_version": 4, "id": "049D", "device_type": 4, "uuid": "u"},
    "gravity_compensation": {"enabled": true, "scaling_factor": 1.0}, "handedness": "right", "streaming_mode": "USB",
    "preset": "defaults", "basis": {"permutation": "XYZ"},
    "mount": {"position": {"x": 0, "y": 0, "z": 0}, "rotation": {"w": 1, "x": 0, "y": 0, "z": 0}, "scale": {"x": 1, "y": 1, "z": 1}},
    "filters": {"force_gate": {"gain": 0.3}, "damping": {"scalar": 0.0}}},
  "state": {"cursor_position": {"x": 0.0, "y": -0.12, "z": 0.15}, "cursor_velocity": {"x": 0.1, "y": 0.2, "z": 0.3},
    "body_orientation": {"w": 1.0, "x": 0.0, "y": 0.0, "z": 0.0}, "current_cursor_force": {"x": 0.0, "y": 0.0, "z": 0.0},
    "control_domain": "cartesian", "control_mode": "idle",
    "transform": {"position": {"x": 0, "y": 0, "z": 0}, "rotation": {"w": 1, "x": 0, "y": 0, "z": 0}, "scale": {"x": 1, "y": 1, "z": 1}}},
  "status": {"ready": true, "in_use": false}}],
"wireless_verse_grip": [{"device_id": "ABCD", "config": {"type": "wireless_verse_grip", "sub_type": "ruko"},
  "state": {"orientation": {"w": 0.0, "x": 1.0, "y": 0.0, "z": 0.0}, "buttons": {"a": false, "b": true, "c": true}, "hall": 3, "battery_level": 0.8},
  "status": {"connected": true, "awake": true, "ready": true}}]})";

/// Writes a message after the first.
inline std::string haply_state(const std::string& device, double x, bool ready = true) {
  return R"({"inverse3":[{"device_id":")" + device + R"(","state":{"cursor_position":{"x":)" +
         std::to_string(x) + R"(,"y":-0.14,"z":0.17},"cursor_velocity":{"x":0,"y":0,"z":0}},)" +
         R"("status":{"ready":)" + (ready ? "true" : "false") + "}}]}";
}

}  // namespace firstcontact::test
