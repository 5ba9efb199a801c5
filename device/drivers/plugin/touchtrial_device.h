/* touchtrial_device.h: the interface of a device driver that Touchtrial loads as a shared library.
 *
 * Include this file, which needs nothing else, write the functions of touchtrial_device_api, and
 * export touchtrial_device_v1. C99 or any later C or C++. The guide is docs/devices/plugin.md, a
 * complete driver tests/device/drivers/plugin/example_device.c.
 *
 * Frame: right-handed; x to the right, y up, z towards the person; origin in the middle of the
 * workspace. Positions in mm, velocities in mm/s, forces on the hand in N.
 *
 * Threads: the host opens, describes and closes a device on a thread of its choice, and calls
 * sample, force and enable on one thread of its own, max_rate_hz times a second: sample, then
 * force. Two functions of one device never run at a time. Two devices may be used at a time, unless
 * open refuses the second.
 *
 * Time: sample and force together take less than half of a period of max_rate_hz. They may wait for
 * the device for that long, but never longer: a driver with a slow link talks to it on a thread of
 * its own. After 10 ms without a new reading the host ends the run as a fault, and after 0.3 s of new
 * readings of one position, the same to the last bit, while it renders at least 1 N: a hand trembles.
 *
 * Safety: every force has passed the host's safety chain. A driver must not add to it, delay it, or
 * keep it: each call replaces the force of the one before. The host sends zero while the device is
 * not ready, when its servo is late by 10 ms, after a fault, and five times before it closes the
 * device.
 *
 * No function may throw, exit, or change how the process handles signals or schedules threads that
 * are not the driver's own. */
#ifndef TOUCHTRIAL_DEVICE_H
#define TOUCHTRIAL_DEVICE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Of this file. A host refuses any other. */
#define TOUCHTRIAL_DEVICE_VERSION 1

/* What sample, force and enable return. After anything but OK the host sends zeros alone, and closes
 * the device; a person then opens it anew. */
#define TOUCHTRIAL_DEVICE_OK 0
#define TOUCHTRIAL_DEVICE_LOST 1         /* unplugged, or no answer */
#define TOUCHTRIAL_DEVICE_BAD_DATA 2     /* its answers make no sense */
#define TOUCHTRIAL_DEVICE_WARM_MOTORS 3  /* its motors are too warm */
#define TOUCHTRIAL_DEVICE_LIMIT_PASSED 4 /* it stopped at a limit of its own */
#define TOUCHTRIAL_DEVICE_FAILED 5       /* anything else */

/* What a person still has to do before the position is valid and force may be sent. */
#define TOUCHTRIAL_DEVICE_READY 0
#define TOUCHTRIAL_DEVICE_NEEDS_HOMING 1      /* move the handle through its whole range */
#define TOUCHTRIAL_DEVICE_NEEDS_INKWELL 2     /* put the stylus into its inkwell */
#define TOUCHTRIAL_DEVICE_NEEDS_CALIBRATION 3 /* run the maker's own calibration */

/* Shape of the workspace between its two corners. */
#define TOUCHTRIAL_DEVICE_BOX 0
#define TOUCHTRIAL_DEVICE_ELLIPSOID 1 /* the one that touches the box from inside */

/* One open device; the driver alone knows what it is. */
typedef struct touchtrial_device touchtrial_device;

/* What a session records of the device. The host sets everything to zero and size to what it has
 * room for; write no further than that. Texts are UTF-8 and end with a zero byte. */
typedef struct {
  uint32_t size;
  uint32_t shape;    /* TOUCHTRIAL_DEVICE_BOX or _ELLIPSOID */
  char model[64];    /* may be empty */
  char serial[64];   /* not empty: certificates belong to one device */
  char firmware[64]; /* version; may be empty */
  double max_force_n;            /* peak, > 0, <= 100 */
  double continuous_force_n;     /* held for any time, <= max_force_n; 0: not known */
  double max_rate_hz;            /* 500 to 10,000: how often the host calls sample and force */
  double max_stiffness_n_per_mm; /* of a wall that it renders stably, <= 100; 0: not known */
  double workspace_least_mm[3];
  double workspace_greatest_mm[3]; /* each side 1 to 2,000 mm */
} touchtrial_device_description;

/* One reading. The host sets everything to zero and size to what it has room for. */
typedef struct {
  uint32_t size;
  uint32_t readiness; /* TOUCHTRIAL_DEVICE_READY or what is needed */
  /* 1, 2, 3 and so on: a new number for a new reading only. The same number again says that there
   * is no newer one; a smaller one is a fault. */
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
   * error: for one line of UTF-8 that says what failed and the remedy, at most error_size bytes
   *   including its zero byte
   * returns NULL if it fails; open it may be called again then */
  touchtrial_device* (*open)(const char* settings, char* error, size_t error_size);
  int32_t (*describe)(touchtrial_device* device, touchtrial_device_description* description);
  /* The newest reading. */
  int32_t (*sample)(touchtrial_device* device, touchtrial_device_sample* sample);
  /* The force on the hand from now on. */
  int32_t (*force)(touchtrial_device* device, const double force_n[3]);
  /* May be NULL if a force of zero leaves no force on the hand. 1: forces follow. 0: none does, as
   * the servo ended, was halted or is late, or the device is not ready; the motors must be without
   * any force, also of what carries the handle's weight. Zero forces go on in that state. */
  int32_t (*enable)(touchtrial_device* device, int32_t on);
  /* Switches the motors off and frees everything. */
  void (*close)(touchtrial_device* device);
} touchtrial_device_api;

#if defined(_WIN32)
#define TOUCHTRIAL_DEVICE_EXPORT __declspec(dllexport)
#else
#define TOUCHTRIAL_DEVICE_EXPORT __attribute__((visibility("default")))
#endif

/* The one function that a driver must export. What it returns stays valid for ever. */
TOUCHTRIAL_DEVICE_EXPORT const touchtrial_device_api* touchtrial_device_v1(void);

/* Optional, for `touchtrial device conform`: the force that the motors of the device opened last are
 * told now, after everything that the driver does to it; after closing too. As the device reports
 * it, if it does. Any thread may call it at any time.
 * returns 0; anything else if it is not known */
TOUCHTRIAL_DEVICE_EXPORT int32_t touchtrial_device_observe_v1(double force_n[3]);

#ifdef __cplusplus
}
#endif

#endif
