#include "protocols/session/exploration_record.hpp"

#include "protocols/session/trial_measures.hpp"

#include <algorithm>
#include <utility>

namespace touchtrial::session {
namespace {

/// Of two explorations of one presentation: the worse of each.
store::ServoHealth joined(const store::ServoHealth& one, const store::ServoHealth& other) {
  return {.rate_hz = std::min(one.rate_hz, other.rate_hz),
          .lateness_p50_us = std::max(one.lateness_p50_us, other.lateness_p50_us),
          .lateness_p99_us = std::max(one.lateness_p99_us, other.lateness_p99_us),
          .lateness_p999_us = std::max(one.lateness_p999_us, other.lateness_p999_us),
          .lateness_worst_us = std::max(one.lateness_worst_us, other.lateness_worst_us),
          .lost = one.lost + other.lost,
          .held = one.held + other.held};
}

}  // namespace

void ExplorationRecord::begin() {
  if (packing_.valid()) packing_.wait();
  packing_ = {};
  trace_.samples.clear();
  explorations_.clear();
  ticks_ = overruns_ = limited_ticks_ = held_in_contact_ = 0;
  health_.reset();
}

store::Trace& ExplorationRecord::next_trace() {
  if (packing_.valid()) packing_.wait();
  return explorations_.empty() ? trace_ : more_;
}

void ExplorationRecord::add(const Exploration& done) {
  const store::Trace& part = explorations_.empty() ? trace_ : more_;
  explorations_.push_back(static_cast<std::int64_t>(part.samples.size()));
  if (explorations_.size() > 1) {
    trace_.samples.insert(trace_.samples.end(), more_.samples.begin(), more_.samples.end());
  }
  ticks_ += done.servo.ticks + done.servo.overruns;
  overruns_ += done.servo.overruns;
  limited_ticks_ += done.servo.limited_ticks;
  held_in_contact_ += done.held_in_contact;
  force_limit_n_ = done.servo.force_limit_n;
  if (done.health) health_ = health_ ? joined(*health_, *done.health) : *done.health;
}

void ExplorationRecord::pack(const Session& session, bool beside) {
  const int trial = session.current()->trial;
  packing_ = std::async(beside ? std::launch::async : std::launch::deferred,
                        [this, &session, trial] { return judged(session, trial); });
}

store::TraceBody ExplorationRecord::body(int trial) const {
  store::TraceBody body;
  body.trial = trial;
  body.rate_hz = trace_.rate_hz;
  body.overruns = overruns_;
  body.servo = health_;
  if (explorations_.size() > 1) body.explorations = explorations_;
  return body;
}

JudgedEvidence ExplorationRecord::judged(const Session& session, int trial) const {
  TrialFindings findings = findings_of(trace_, force_limit_n_);
  if (held_in_contact_ > 0) findings.measures.within_limits = false;
  store::TraceBody body = this->body(trial);
  body.valid = findings.long_enough;
  if (health_) findings.measures.limited_ticks = limited_ticks_;
  return {session.packed(body, findings.measures, trace_), findings.valid()};
}

}  // namespace touchtrial::session
