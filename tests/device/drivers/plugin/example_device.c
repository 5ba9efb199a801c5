/* example_device.c: a complete driver for Touchtrial, to begin one's own with. It needs no device:
 * it is a mass of 100 g, which a spring ties to a hand that moves to and fro. Replace what is
 * marked REAL DEVICE. Build it, and let the program check it:
 *
 *   cc -std=c99 -O2 -shared -fPIC -I device/drivers/plugin tests/device/drivers/plugin/example_device.c \
 *      -o example.so -lm -lpthread
 *   touchtrial device conform ./example.so --force
 */
#include "touchtrial_device.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define RATE_HZ 1000.0
#define MAX_FORCE_N 3.0
#define SPRING_N_PER_MM 0.1
#define DAMPING_N_S_PER_MM 0.004
#define REACH_MM 60.0

struct touchtrial_device {
  double mass_kg;
  long homing_ticks; /* until the device knows where it is */
  long tick;
  double position_mm[3];
  double velocity_mm_s[3];
  double force_n[3]; /* as the motors are told */
  int enabled;
};

/* Only one device is there, so that a second opening is refused. The force outlives the device, for
 * observe; any thread may ask for it, so that a lock guards it. */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static int in_use = 0;
static double observed_n[3];

/* Sends the force to the motors. REAL DEVICE: write to the device here. */
static void tell_motors(touchtrial_device* device, const double force_n[3]) {
  memcpy(device->force_n, force_n, sizeof device->force_n);
  pthread_mutex_lock(&lock);
  memcpy(observed_n, force_n, sizeof observed_n);
  pthread_mutex_unlock(&lock);
}

/* The number behind a key of a flat JSON object. A real driver may use a JSON library. */
static double number_of(const char* settings, const char* key, double otherwise) {
  char quoted[64];
  const char* found;
  snprintf(quoted, sizeof quoted, "\"%s\":", key); /* the host writes no space there */
  found = strstr(settings, quoted);
  return found == NULL ? otherwise : strtod(found + strlen(quoted), NULL);
}

/* \return whether nobody else had it */
static int take(void) {
  int was_free;
  pthread_mutex_lock(&lock);
  was_free = !in_use;
  in_use = 1;
  pthread_mutex_unlock(&lock);
  return was_free;
}

static void give_back(void) {
  pthread_mutex_lock(&lock);
  in_use = 0;
  pthread_mutex_unlock(&lock);
}

static touchtrial_device* example_open(const char* settings, char* error, size_t error_size) {
  const double mass_kg = number_of(settings, "mass_kg", 0.1);
  touchtrial_device* device;
  if (!(mass_kg >= 0.01 && mass_kg <= 1.0)) {
    snprintf(error, error_size, "mass_kg is %g; give 0.01 to 1", mass_kg);
    return NULL;
  }
  if (!take()) {
    snprintf(error, error_size, "the device is open already; close the other program");
    return NULL;
  }
  /* REAL DEVICE: open the port here. */
  device = calloc(1, sizeof *device);
  if (device == NULL) {
    snprintf(error, error_size, "no memory; close other programs");
    give_back();
    return NULL;
  }
  device->mass_kg = mass_kg;
  device->homing_ticks = (long)number_of(settings, "homing_ticks", 0.0);
  return device;
}

static int32_t example_describe(touchtrial_device* device, touchtrial_device_description* told) {
  int axis;
  (void)device;
  told->shape = TOUCHTRIAL_DEVICE_ELLIPSOID;
  snprintf(told->model, sizeof told->model, "simulated mass");
  snprintf(told->serial, sizeof told->serial, "0001");
  snprintf(told->firmware, sizeof told->firmware, "1.0");
  told->max_force_n = MAX_FORCE_N;
  told->continuous_force_n = 1.0;
  told->max_rate_hz = RATE_HZ;
  told->max_stiffness_n_per_mm = 1.0;
  for (axis = 0; axis < 3; ++axis) {
    told->workspace_least_mm[axis] = -REACH_MM;
    told->workspace_greatest_mm[axis] = REACH_MM;
  }
  return TOUCHTRIAL_DEVICE_OK;
}

static int is_homed(const touchtrial_device* device) {
  return device->tick >= device->homing_ticks;
}

/* REAL DEVICE: read the newest position here, and number it. */
static int32_t example_sample(touchtrial_device* device, touchtrial_device_sample* sample) {
  sample->readiness = is_homed(device) ? TOUCHTRIAL_DEVICE_READY : TOUCHTRIAL_DEVICE_NEEDS_HOMING;
  sample->sequence = (uint64_t)device->tick + 1;
  memcpy(sample->position_mm, device->position_mm, sizeof sample->position_mm);
  memcpy(sample->velocity_mm_s, device->velocity_mm_s, sizeof sample->velocity_mm_s);
  return TOUCHTRIAL_DEVICE_OK;
}

/* One tick of the mass: damping fully implicit, so that it is stable at any mass. */
static void move_mass(touchtrial_device* device) {
  const double tick_s = 1.0 / RATE_HZ;
  const double time_s = tick_s * (double)device->tick++;
  const double per_mass = tick_s * 1000.0 / device->mass_kg; /* N to mm/s */
  int axis;
  for (axis = 0; axis < 3; ++axis) {
    const double hand_mm = axis == 0 ? 15.0 * sin(6.2832 * time_s) : 0.0;
    const double pull_n = SPRING_N_PER_MM * (hand_mm - device->position_mm[axis]);
    double* const velocity = &device->velocity_mm_s[axis];
    *velocity = (*velocity + per_mass * (pull_n + device->force_n[axis])) /
                (1.0 + per_mass * DAMPING_N_S_PER_MM);
    device->position_mm[axis] += tick_s * *velocity;
  }
}

static int32_t example_force(touchtrial_device* device, const double force_n[3]) {
  static const double none[3] = {0.0, 0.0, 0.0};
  /* The host holds forces back too; a driver's own care costs nothing. */
  tell_motors(device, device->enabled && is_homed(device) ? force_n : none);
  move_mass(device);
  return TOUCHTRIAL_DEVICE_OK;
}

static int32_t example_enable(touchtrial_device* device, int32_t on) {
  static const double none[3] = {0.0, 0.0, 0.0};
  device->enabled = on != 0;
  if (!on) tell_motors(device, none);
  return TOUCHTRIAL_DEVICE_OK;
}

static void example_close(touchtrial_device* device) {
  (void)example_enable(device, 0);
  free(device); /* REAL DEVICE: close the port here. */
  give_back();
}

const touchtrial_device_api* touchtrial_device_v1(void) {
  static const touchtrial_device_api api = {TOUCHTRIAL_DEVICE_VERSION,
                                            sizeof(touchtrial_device_api),
                                            "example",
                                            example_open,
                                            example_describe,
                                            example_sample,
                                            example_force,
                                            example_enable,
                                            example_close};
  return &api;
}

int32_t touchtrial_device_observe_v1(double force_n[3]) {
  pthread_mutex_lock(&lock);
  memcpy(force_n, observed_n, sizeof observed_n);
  pthread_mutex_unlock(&lock);
  return 0;
}
