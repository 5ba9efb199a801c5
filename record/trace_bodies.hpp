/// \file The body of `trace-stored` and its secret: the quality of a trial.
#pragma once

#include "core/hash.hpp"
#include "record/body_io.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace touchtrial::record {

/// The servo's timing. The start of a tick depends on the operating system, not on the texture.
struct ServoHealth {
  double rate_hz = 0.0;
  double lateness_p50_us = 0.0;
  double lateness_p99_us = 0.0;
  double lateness_p999_us = 0.0;
  double lateness_worst_us = 0.0;
  std::int64_t lost = 0;
  std::int64_t held = 0;

  void describe(BodyIo& io) {
    io("rate_hz", rate_hz, "the achieved rate");
    io("lateness_p50_us", lateness_p50_us, "median lateness of the ticks' beginnings");
    io("lateness_p99_us", lateness_p99_us, "99th percentile");
    io("lateness_p999_us", lateness_p999_us, "99.9th percentile");
    io("lateness_worst_us", lateness_worst_us, "maximum");
    io("lost", lost, "samples that did not reach the trace");
    io("held", held,
       "samples of the trace that repeat the previous one, in place of overruns and lost samples; "
       "if one is in contact, `within_limits` is false");
  }
  friend bool operator==(const ServoHealth&, const ServoHealth&) = default;
};

/// Whether the hand stayed within each window of the instructions. Only the hand's own motion and
/// force count: with the forces of the texture, the windows would distinguish rough textures from
/// smooth ones.
struct HandWindows {
  bool contact = true;
  bool path = true;
  bool force = true;
  bool speed = true;

  void describe(BodyIo& io) {
    io("contact_ok", contact, "the hand was at the plane long enough");
    io("path_ok", path, "it moved far enough along it");
    io("force_ok", force, "it pressed neither too lightly nor too hard");
    io("speed_ok", speed, "it moved neither too slowly nor too fast");
  }
  friend bool operator==(const HandWindows&, const HandWindows&) = default;
};

/// `trace-stored`. Its sealed members are 0 or empty unless it is opened.
struct TraceBody {
  int trial = 0;
  std::int64_t samples = 0;
  double rate_hz = 0.0;
  std::int64_t overruns = 0;
  bool valid = true;
  HandWindows hand{};
  bool saturated = false;
  Digest trace{};
  double largest_force_n = 0.0;
  std::vector<std::int64_t> explorations{};
  std::vector<std::int64_t> began_ns{};
  std::optional<ServoHealth> servo{};

  void describe(BodyIo& io) {
    io("trial", trial, "number of the trial", {.min = 1});
    io("samples", samples, "of the trace", {.sealed = true});
    io("rate_hz", rate_hz, "of the trace");
    io("overruns", overruns, "ticks that started too late");
    io("valid", valid, "by the clear part of the validity rule; the other part is sealed");
    hand.describe(io);
    io("saturated", saturated, "at least 1 % of the samples in contact were at the force limit",
       {.sealed = true});
    io("trace", trace, "BLAKE2b of the stored box");
    io("largest_force_n", largest_force_n, "of the trace", {.sealed = true});
    io.omit_if_empty(
        "explorations", explorations,
        "samples of each exploration, or of each interval of the trial, if there were several",
        {.sealed = true});
    io.omit_if_empty(
        "began_ns", began_ns,
        "time of each one's first sample since `presented`; absent: 0 for one exploration, not "
        "recorded for several",
        {.sealed = true});
    io.part("servo", servo, "only in real time");
  }
};

/// The secret of a `trace-stored`: numbers that depend on the stimulus.
struct TrialMeasures {
  double contact_s = 0.0;
  double path_mm = 0.0;
  double force_rms_n = 0.0;
  double saturated_share = 0.0;
  bool within_limits = true;
  std::optional<std::int64_t> limited_ticks{};

  void describe(BodyIo& io) {
    io("contact_s", contact_s, "time in contact");
    io("path_mm", path_mm, "length of the stylus' path in contact");
    io("force_rms_n", force_rms_n, "root mean square of the force in contact");
    io("saturated_share", saturated_share, "share of ticks in contact at the force limit");
    io("within_limits", within_limits, "the part of the validity rule that depends on forces");
    io("limited_ticks", limited_ticks,
       "in real time: ticks whose force the safety chain or the device's own limit changed");
  }
  friend bool operator==(const TrialMeasures&, const TrialMeasures&) = default;
};

}  // namespace touchtrial::record
