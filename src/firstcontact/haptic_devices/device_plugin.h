/**
 * @file
 * The interface of plug-ins for haptic devices, in C.
 *
 * A plug-in is a shared library that drives the device of a vendor by the vendor's own software.
 * It exports one function, firstcontact_device_plugin(). The interface is in C, so that compilers,
 * their flags and versions of libraries need not agree. This header needs nothing else of
 * firstcontact. docs/haptic_devices.md shows how to build one; examples/cpp/orbit_plugin.cpp is
 * one.
 *
 * Frame D is fixed to the base of the device: right-handed, x to the right of the user, y away from
 * the user, z up. H is the handle. Units are m, rad, s, N, N m; times are nanoseconds.
 */

#ifndef FIRSTCONTACT_HAPTIC_DEVICES_DEVICE_PLUGIN_H
#define FIRSTCONTACT_HAPTIC_DEVICES_DEVICE_PLUGIN_H

#include <stddef.h>
#include <stdint.h>

/* NOLINTBEGIN(readability-identifier-naming): the names are those of C. */

#ifdef __cplusplus
extern "C" {
#endif

/** The version of this interface. It changes with each change of a structure or a promise. */
#define FIRSTCONTACT_DEVICE_PLUGIN_ABI 1

/** The meaning of the numbers of a device. */
enum {
  FIRSTCONTACT_DEVICE_POSE = 0, /**< The handle is at a place. */
  FIRSTCONTACT_DEVICE_RATE = 1  /**< A deflected cap sets velocities. */
};

/** The worth of a state. */
enum {
  FIRSTCONTACT_DEVICE_WAITING = 0, /**< No sample has come yet. */
  FIRSTCONTACT_DEVICE_LIVE = 1,    /**< The sample counts. */
  FIRSTCONTACT_DEVICE_SILENT = 2,  /**< Connected, but the sample is too old. */
  FIRSTCONTACT_DEVICE_LOST = 3     /**< The device is gone. It may come back. */
};

/** The abilities and limits of a device. All is 0 before the plug-in fills it in. */
struct firstcontact_device_abilities {
  char name[64];                /**< Name of the model, ended by 0. */
  char id[64];                  /**< Name of the specimen, ended by 0. */
  int32_t kind;                 /**< FIRSTCONTACT_DEVICE_POSE or _RATE. */
  int32_t buttons;              /**< Number of buttons, 0 to 32. */
  uint8_t sensed[6];            /**< 1 where sensed: along x, y, z, about x, y, z. */
  uint8_t driven[6];            /**< 1 where driven. */
  uint8_t reserved[4];          /**< 0. */
  double max_force;             /**< [N]         Infinite where the vendor states none. */
  double max_torque;            /**< [N m] */
  double max_stiffness;         /**< [N/m] */
  double max_angular_stiffness; /**< [N m/rad] */
  double max_damping;           /**< [N s/m] */
  double max_angular_damping;   /**< [N m s/rad] */
  double workspace_radius;      /**< [m]         Reach about the origin of D; 0 for unknown. */
  double damping;               /**< [N s/m]     Own damping of the mechanism, at least. */
  double angular_damping;       /**< [N m s/rad] */
  double friction;              /**< [N]         Own Coulomb friction, at least. */
  double angular_friction;      /**< [N m] */
  double resolution;            /**< [m]         Step of the encoders, at most. */
  double angular_resolution;    /**< [rad] */
  double sample_rate;           /**< [Hz]        0 where it is not regular. */
};

/** One sample. All is 0 before the plug-in fills it in. */
struct firstcontact_device_sample {
  double position[3];        /**< [m]     Position of H's origin in D. */
  double quaternion_wxyz[4]; /**< [-]     Unit quaternion: turns axes of H to those of D. */
  double linear_rate[3];     /**< [m/s]   Set by a rate device; else measured, or 0. */
  double angular_rate[3];    /**< [rad/s] */
  int64_t time_ns;           /**< When the sample was taken, on the clock of now_ns. */
  uint64_t sequence;         /**< Counts the samples. */
  uint32_t buttons;          /**< Bit i is set while button i is pressed. */
  int32_t status;            /**< FIRSTCONTACT_DEVICE_WAITING and so on. */
};

/** The functions of a plug-in. `device` is what `open` returned. None may throw. */
struct firstcontact_device_plugin_functions {
  uint32_t abi;            /**< FIRSTCONTACT_DEVICE_PLUGIN_ABI, as the plug-in was compiled. */
  uint32_t sample_size;    /**< sizeof(struct firstcontact_device_sample) */
  uint32_t abilities_size; /**< sizeof(struct firstcontact_device_abilities) */
  uint32_t reserved;       /**< 0. */

  /**
   * Opens the device. May block.
   *
   * @param settings      text of the user, as "serial=12"; never null
   * @param problem       takes the reason of a failure, ended by 0
   * @param problem_size  [byte]  room in it
   * @returns null on failure
   */
  void* (*open)(const char* settings, char* problem, size_t problem_size);

  /** Fills in the abilities. Called once after `open`. */
  void (*describe)(void* device, struct firstcontact_device_abilities* abilities);

  /**
   * Gives the newest sample. Called at 1 kHz to 10 kHz: it must not block, allocate or lock. A
   * library of a vendor that blocks belongs into a thread of the plug-in.
   */
  void (*read)(void* device, int64_t now_ns, struct firstcontact_device_sample* sample);

  /**
   * Commands a force from now on: [N] and [N m], at H's origin, axes of D. Finite, and within the
   * abilities. The same rules as for `read`. The plug-in falls back to zero where no command came
   * for 100 ms.
   */
  void (*command)(void* device, int64_t now_ns, const double force[3], const double torque[3]);

  /** Sets the force to zero and closes the device. */
  void (*close)(void* device);
};

/** The most values of grips that a device senses. */
#define FIRSTCONTACT_DEVICE_MOST_GRIPS 16

/** The abilities of a glove or a gripper. All is 0 before the plug-in fills it in. */
struct firstcontact_device_grip_abilities {
  int32_t grips;          /**< 0 to FIRSTCONTACT_DEVICE_MOST_GRIPS: values that are sensed. */
  int32_t reserved;       /**< 0. */
  double max_grip_effort; /**< [J]  Greatest effort of a grip; 0 where none is driven. */
};

/** The functions of a plug-in whose device has grips, beside the others. */
struct firstcontact_device_grip_functions {
  uint32_t abi;            /**< FIRSTCONTACT_DEVICE_PLUGIN_ABI, as the plug-in was compiled. */
  uint32_t abilities_size; /**< sizeof(struct firstcontact_device_grip_abilities) */

  /** Fills in the abilities. Called once after `describe` of the device. */
  void (*describe)(void* device, struct firstcontact_device_grip_abilities* abilities);

  /**
   * Gives the values of the newest sample of `read` of the device: 0 open, 1 closed. The same
   * rules hold as for that function.
   */
  void (*read)(void* device, double values[FIRSTCONTACT_DEVICE_MOST_GRIPS]);

  /**
   * Commands the efforts on the values from now on [J]. Called after `command` of the device, by
   * the same rules. Null where no grip is driven.
   */
  void (*command)(void* device, int64_t now_ns,
                  const double efforts[FIRSTCONTACT_DEVICE_MOST_GRIPS]);
};

/** The one function that a plug-in exports. The structure lives as long as the library. */
#if defined(__GNUC__)
__attribute__((visibility("default")))
#endif
const struct firstcontact_device_plugin_functions*
firstcontact_device_plugin(void);

/** A second function, exported only by a plug-in whose device has grips. */
#if defined(__GNUC__)
__attribute__((visibility("default")))
#endif
const struct firstcontact_device_grip_functions*
firstcontact_device_plugin_grips(void);

#ifdef __cplusplus
}
#endif

/* NOLINTEND(readability-identifier-naming) */

#endif
