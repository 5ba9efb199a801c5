/* touchtrial_device.h: the interface of a device driver that Touchtrial loads as a shared library.
 *
 * Include this file, which has no dependencies, implement the functions of touchtrial_device_api, and
 * export touchtrial_device_v1. C99 or any later C or C++. Guide: docs/devices/plugin.md. Complete
 * example: tests/device/drivers/plugin/example_device.c.
 *
 * Frame: right-handed; x to the right, y up, z towards the person; origin in the middle of the
 * workspace. Positions in mm, velocities in mm/s, forces on the hand in N.
 *
 * Threads: the host calls open, describe and close on any thread, and sample, force and enable on
 * one dedicated thread: sample, then force, max_rate_hz times per second. Functions of one device
 * never run concurrently. Two devices may be open at a time, unless open refuses the second.
 *
 * Time: sample and force together must take less than half a period of max_rate_hz, including any
 * wait for the device; a driver with a slow link must communicate on its own thread. The host ends
 * the run with a fault after 10 ms without a new reading, or after 0.3 s of new readings at exactly
 * the same position while it renders at least 1 N, because a hand always trembles.
 *
 * Safety: every force has passed the host's safety chain. A driver must not increase, delay or
 * accumulate forces: each call replaces the previous force. The host sends zero while the device is
 * not ready, when its servo is late by 10 ms, after a fault, and five times before it closes the
 * device.
 *
 * No function may throw, exit, or change the process's signal handling or the scheduling of threads
 * that the driver did not create. */
#ifndef TOUCHTRIAL_DEVICE_H
#define TOUCHTRIAL_DEVICE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The version of this interface. The host refuses any other. */
#define TOUCHTRIAL_DEVICE_VERSION 1

/* Return values of sample, force and enable. After any other value than OK the host sends only zeros
 * and closes the device; a person must reopen it. */
#define TOUCHTRIAL_DEVICE_OK 0
#define TOUCHTRIAL_DEVICE_LOST 1         /* unplugged, or no answer */
#define TOUCHTRIAL_DEVICE_BAD_DATA 2     /* its answers are invalid */
#define TOUCHTRIAL_DEVICE_WARM_MOTORS 3  /* its motors are too warm */
#define TOUCHTRIAL_DEVICE_LIMIT_PASSED 4 /* it stopped at one of its own limits */
#define TOUCHTRIAL_DEVICE_FAILED 5       /* anything else */

/* What a person must do before the position is valid and force may be sent. */
#define TOUCHTRIAL_DEVICE_READY 0
#define TOUCHTRIAL_DEVICE_NEEDS_HOMING 1      /* move the handle through its whole range */
#define TOUCHTRIAL_DEVICE_NEEDS_INKWELL 2     /* put the stylus into its inkwell */
#define TOUCHTRIAL_DEVICE_NEEDS_CALIBRATION 3 /* run the maker's own calibration */

/* Shape of the workspace between its two corners. */
#define TOUCHTRIAL_DEVICE_BOX 0
#define TOUCHTRIAL_DEVICE_ELLIPSOID 1 /* the ellipsoid inscribed in the box */

/* An open device; opaque to the host. */
typedef struct touchtrial_device touchtrial_device;

/* The description of the device in a session's record. The host zeroes the structure and sets size
 * to its own size in bytes; do not write beyond it. Texts are UTF-8 and end with a zero byte. */
typedef struct {
  uint32_t size;
  uint32_t shape;    /* TOUCHTRIAL_DEVICE_BOX or _ELLIPSOID */
  char model[64];    /* may be empty */
  char serial[64];   /* not empty: certificates belong to one device */
  char firmware[64]; /* version; may be empty */
  double max_force_n;            /* peak, > 0, <= 100 */
  double continuous_force_n;     /* sustainable without time limit, <= max_force_n; 0: unknown */
  double max_rate_hz;            /* 500 to 10,000: how often the host calls sample and force */
  double max_stiffness_n_per_mm; /* of a wall that it renders stably, <= 100; 0: unknown */
  double workspace_least_mm[3];
  double workspace_greatest_mm[3]; /* each side 1 to 2,000 mm */
} touchtrial_device_description;

/* One reading. The host sets size as in touchtrial_device_description. */
typedef struct {
  uint32_t size;
  uint32_t readiness; /* TOUCHTRIAL_DEVICE_READY or what is needed */
  /* Counts readings from 1. An unchanged number means no newer reading; a smaller one is a fault. */
  uint64_t sequence;
  double position_mm[3];
  double velocity_mm_s[3];
  uint32_t buttons; /* bit i is button i, set while it is down */
  uint32_t reserved;
} touchtrial_device_sample;

typedef struct {
  uint32_t version; /* TOUCHTRIAL_DEVICE_VERSION */
  uint32_t size;    /* sizeof(touchtrial_device_api) */
  const char* name; /* of the driver: 1 to 32 letters, digits, - and _ */

  /* Opens the device; no force. May take seconds.
   * settings: the JSON object at plugin.settings of the host's device settings; {} if there is none
   * error: receives one line of UTF-8 with the failure and its remedy, at most error_size bytes
   *   including the zero byte
   * returns NULL on failure; the host may call open again */
  touchtrial_device* (*open)(const char* settings, char* error, size_t error_size);
  int32_t (*describe)(touchtrial_device* device, touchtrial_device_description* description);
  /* The newest reading. */
  int32_t (*sample)(touchtrial_device* device, touchtrial_device_sample* sample);
  /* The force on the hand from now on. */
  int32_t (*force)(touchtrial_device* device, const double force_n[3]);
  /* May be NULL if a force of zero leaves no force on the hand. 1: forces follow. 0: the servo has
   * ended, was halted or is late, or the device is not ready; the motors must exert no force at all,
   * not even to support the handle's weight. The host continues to send zero in that state. */
  int32_t (*enable)(touchtrial_device* device, int32_t on);
  /* Switches the motors off and frees everything. */
  void (*close)(touchtrial_device* device);
} touchtrial_device_api;

#if defined(_WIN32)
#define TOUCHTRIAL_DEVICE_EXPORT __declspec(dllexport)
#else
#define TOUCHTRIAL_DEVICE_EXPORT __attribute__((visibility("default")))
#endif

/* The only function that a driver must export. The returned pointer stays valid for ever. */
TOUCHTRIAL_DEVICE_EXPORT const touchtrial_device_api* touchtrial_device_v1(void);

/* Optional, for `touchtrial device conform`: the current force command to the motors of the last
 * opened device, after all processing by the driver, or as the device reports it. Any thread may
 * call it at any time, even after close.
 * returns 0; any other value if the force is unknown */
TOUCHTRIAL_DEVICE_EXPORT int32_t touchtrial_device_observe_v1(double force_n[3]);

#ifdef __cplusplus
}
#endif

#endif
