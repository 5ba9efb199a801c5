#include "device/servo/running_servo.hpp"

#include <memory>
#include <utility>

namespace touchtrial::device {
namespace {

/// Tells of the end also when the work throws.
struct EndTeller {
  std::promise<void>& promise;
  ~EndTeller() { promise.set_value(); }
};

}  // namespace

RunningServo::RunningServo(ServoThread& thread, ServoControl& control, std::function<void()> work)
    : thread_(thread), control_(control) {
  auto promise = std::make_shared<std::promise<void>>();
  ended_ = promise->get_future();
  thread_.start([work = std::move(work), promise = std::move(promise)] {
    const EndTeller teller{*promise};
    work();
  });
}

RunningServo::~RunningServo() {
  if (!ended_.valid()) return;
  control_.emergency_stop();
  try {
    finish();
  } catch (...) {  // Another exception is on its way.
  }
}

bool RunningServo::runs(std::chrono::nanoseconds patience) const {
  return ended_.wait_for(patience) != std::future_status::ready;
}

void RunningServo::finish() {
  ended_.get();
  thread_.wait();
}

}  // namespace touchtrial::device
