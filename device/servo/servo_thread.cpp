#include "device/servo/servo_thread.hpp"

#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

namespace touchtrial::device {

struct ServoThread::State {
  using Work = std::packaged_task<void()>;

  /// The thread's main function: runs work until `end`.
  void serve(const SchedulingRequest& request, std::promise<SchedulingObtained> scheduled) {
    scheduled.set_value(request_scheduling(request));
    for (Work work = take_next(); work.valid(); work = take_next()) work();
  }

  /// \return no work when the thread is to end
  Work take_next() {
    std::unique_lock lock(mutex);
    state_changed.wait(lock, [this] { return pending.valid() || is_ending; });
    return std::exchange(pending, Work());
  }

  void submit(Work work) {
    const std::lock_guard lock(mutex);
    pending = std::move(work);
    state_changed.notify_one();
  }

  void end() {
    const std::lock_guard lock(mutex);
    is_ending = true;
    state_changed.notify_one();
  }

  std::mutex mutex;
  std::condition_variable state_changed;
  Work pending;
  bool is_ending = false;
  std::future<void> result;
  SchedulingObtained scheduling;
  std::thread thread;
};

ServoThread::ServoThread(const SchedulingRequest& request) : state_(std::make_unique<State>()) {
  std::promise<SchedulingObtained> scheduled;
  std::future<SchedulingObtained> scheduling = scheduled.get_future();
  state_->thread = std::thread(&State::serve, state_.get(), request, std::move(scheduled));
  state_->scheduling = scheduling.get();
}

ServoThread::~ServoThread() {
  state_->end();
  state_->thread.join();
}

const SchedulingObtained& ServoThread::scheduling() const noexcept {
  return state_->scheduling;
}

void ServoThread::start(std::function<void()> work) {
  if (state_->result.valid()) {
    throw std::logic_error("ServoThread: call wait() for the previous work first");
  }
  State::Work task(std::move(work));
  state_->result = task.get_future();
  state_->submit(std::move(task));
}

bool ServoThread::running() const noexcept {
  const auto& result = state_->result;
  return result.valid() && result.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
}

void ServoThread::wait() {
  if (state_->result.valid()) state_->result.get();
}

void ServoThread::run(std::function<void()> work) {
  start(std::move(work));
  wait();
}

RunningServo::RunningServo(ServoThread& thread, ServoControl& control, std::function<void()> work)
    : thread_(thread), control_(control) {
  auto promise = std::make_shared<std::promise<void>>();
  completion_ = promise->get_future();
  thread_.start([work = std::move(work), promise = std::move(promise)] {
    struct EndNotifier {  // also if the work throws
      std::promise<void>& promise;
      ~EndNotifier() { promise.set_value(); }
    };
    const EndNotifier notifier{*promise};
    work();
  });
}

RunningServo::~RunningServo() {
  if (!completion_.valid()) return;
  control_.emergency_stop();
  try {
    finish();
  } catch (...) {  // another exception is propagating
  }
}

bool RunningServo::is_running(std::chrono::nanoseconds timeout) const {
  return completion_.wait_for(timeout) != std::future_status::ready;
}

void RunningServo::finish() {
  completion_.get();
  thread_.wait();
}

}  // namespace touchtrial::device
