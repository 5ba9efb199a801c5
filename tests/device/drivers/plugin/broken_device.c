/* The example with one fault, which plugin.settings names: {"fault": "values"}. What a library has
 * before it is opened is broken by the environment variable BROKEN_DEVICE. Each fault is one that a
 * driver could have, in the place where a check looks for it. */
#define _POSIX_C_SOURCE 200809L
#define touchtrial_device_v1 example_device_v1
#include "example_device.c"
#undef touchtrial_device_v1

#include <time.h>

#define LINGERING_TICKS 150

static const touchtrial_device_api* example(void) {
  return example_device_v1();
}

/* Of the one open device. */
static char fault[32];
static long samples;
static long openings;
static long linger;
static int letting_go; /* how often a force has ended */
static int dead;       /* no force passes any more */
static int taken_away; /* by a second opening */
static int was_told;   /* a force since the opening */
static double last_n[3];

static int has(const char* name) {
  return strcmp(fault, name) == 0;
}

static int is_broken_by(const char* name) {
  const char* const broken = getenv("BROKEN_DEVICE");
  return broken != NULL && strcmp(broken, name) == 0;
}

static void read_fault(const char* settings) {
  const char* found = strstr(settings, "\"fault\":\"");
  fault[0] = '\0';
  if (found != NULL) sscanf(found + 9, "%31[a-z_]", fault);
}

static touchtrial_device* broken_open(const char* settings, char* error, size_t error_size) {
  touchtrial_device* device;
  read_fault(settings);
  if (has("opening")) {
    memset(error, 'x', error_size); /* without an end */
    return NULL;
  }
  device = example()->open(settings, error, error_size);
  if (device == NULL) {
    taken_away = has("opening_twice");
    return NULL;
  }
  if (is_broken_by("no_enable")) device->enabled = 1;
  samples = linger = 0;
  letting_go = dead = taken_away = was_told = 0;
  memset(last_n, 0, sizeof last_n);
  ++openings;
  return device;
}

static int32_t broken_describe(touchtrial_device* device, touchtrial_device_description* told) {
  const int32_t result = example()->describe(device, told);
  if (has("description")) told->max_force_n = NAN;
  if (has("endless_text")) memset(told->model, 'm', sizeof told->model);
  if (has("no_serial")) told->serial[0] = '\0';
  if (has("inverted_workspace")) told->workspace_least_mm[1] = 70.0;
  if (has("reopening")) snprintf(told->serial, sizeof told->serial, "%ld", openings);
  if (has("describe_writes_past")) memset((char*)told + told->size, 0, 16);
  return has("describe_fails") ? 17 : result;
}

static void sleep_30_ms(void) {
  const struct timespec time = {0, 30 * 1000 * 1000};
  nanosleep(&time, NULL);
}

static int32_t broken_sample(touchtrial_device* device, touchtrial_device_sample* sample) {
  const int32_t result = example()->sample(device, sample);
  const long number = ++samples;
  int axis;
  if (has("memory") && number > 100) ((volatile char*)sample)[sample->size + 3] = 1;
  if (has("staying") && number > 300) return TOUCHTRIAL_DEVICE_LOST;
  if (has("warm") && number > 300) return TOUCHTRIAL_DEVICE_WARM_MOTORS;
  if (has("unknown_code") && number > 300) return -12345;
  if (has("numbering") && number > 300) sample->sequence -= 100;
  if (has("standing")) sample->sequence = 7;
  if (has("silent")) sample->sequence = 0;
  if (has("values") && number > 300) sample->position_mm[2] = NAN;
  if (has("huge") && number > 300) sample->velocity_mm_s[1] = 1e300;
  if (has("unknown_readiness") && number > 300) sample->readiness = 99;
  if (has("workspace")) sample->position_mm[1] += 400.0;
  for (axis = 0; has("velocity") && axis < 3; ++axis) sample->velocity_mm_s[axis] *= 0.001;
  if (has("rate")) sample->sequence = 1 + sample->sequence / 3;
  if (has("gaps") && number % 200 < 30) sample->sequence = (uint64_t)(number / 200 * 200);
  if (taken_away) return TOUCHTRIAL_DEVICE_LOST;
  if (has("calls") && number % 40 == 0) sleep_30_ms();
  while (has("hanging") && number > 300) sleep_30_ms();
  return result;
}

static int is_none(const double force_n[3]) {
  return force_n[0] == 0.0 && force_n[1] == 0.0 && force_n[2] == 0.0;
}

/* Lets the n-th force linger after it was to end. */
static int lingers(int which) {
  return (has("lapsing") && which == 1) || (has("halting") && which == 2);
}

static int32_t broken_force(touchtrial_device* device, const double force_n[3]) {
  double told_n[3];
  int32_t result;
  memcpy(told_n, force_n, sizeof told_n);
  if (is_none(force_n)) {
    if (!is_none(last_n)) {
      ++letting_go;
      linger = lingers(letting_go) ? LINGERING_TICKS : 0;
      if (has("rearming") && letting_go == 2) dead = 1;
    }
  } else {
    was_told = 1;
  }
  if (dead) memset(told_n, 0, sizeof told_n);
  if (has("pushing")) {
    told_n[0] = force_n[1];
    told_n[1] = force_n[0];
  }
  result = example()->force(device, told_n);
  if (linger > 0 && --linger > 0) observed_n[0] = 0.3;
  if (has("rest_zero") && !was_told && is_homed(device)) observed_n[1] = 0.2;
  if (has("unready_zero") && !is_homed(device)) observed_n[2] = 0.2;
  memcpy(last_n, force_n, sizeof last_n);
  return result;
}

static void broken_close(touchtrial_device* device) {
  example()->close(device);
  if (has("closing_zero") && was_told) observed_n[1] = 0.3;
}

const touchtrial_device_api* touchtrial_device_v1(void) {
  static touchtrial_device_api api;
  api = *example();
  api.name = "broken-example";
  api.open = broken_open;
  api.describe = broken_describe;
  api.sample = broken_sample;
  api.force = broken_force;
  api.close = broken_close;
  if (is_broken_by("version")) api.version = 2;
  if (is_broken_by("size")) api.size = 24;
  if (is_broken_by("function")) api.force = NULL;
  if (is_broken_by("no_enable")) api.enable = NULL;
  if (is_broken_by("no_name")) api.name = NULL;
  if (is_broken_by("control_name")) api.name = "a\nb";
  if (is_broken_by("long_name")) api.name = "abcdefghijklmnopqrstuvwxyzabcdefghi";
  return is_broken_by("nothing") ? NULL : &api;
}
