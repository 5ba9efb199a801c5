/// \file tbb::parallel_pipeline of a serial source, parallel work and a serial sink in order, in
/// plain threads. See ../README.md.
#pragma once

#include "tbb/worker_threads.h"

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <utility>

namespace tbb {

enum class filter_mode { parallel, serial_in_order };

class flow_control {
 public:
  void stop() noexcept { stopped_ = true; }
  [[nodiscard]] bool stopped() const noexcept { return stopped_; }

 private:
  bool stopped_ = false;
};

namespace plain {

template <typename Item>
struct Source {
  std::function<Item(flow_control&)> next;
};
template <typename Item, typename Result>
struct Work {
  std::function<Result(Item)> run;
};
template <typename Result>
struct Sink {
  std::function<void(Result)> take;
};
template <typename Item, typename Result>
struct Start {
  Source<Item> source;
  Work<Item, Result> work;
};
template <typename Item, typename Result>
struct Pipeline {
  Source<Item> source;
  Work<Item, Result> work;
  Sink<Result> sink;
};

template <typename In, typename Out>
struct FilterOf {
  using Type = Work<In, Out>;
};
template <typename Out>
struct FilterOf<void, Out> {
  using Type = Source<Out>;
};
template <typename In>
struct FilterOf<In, void> {
  using Type = Sink<In>;
};

template <typename Item, typename Result>
Start<Item, Result> operator&(Source<Item> source, Work<Item, Result> work) {
  return {std::move(source), std::move(work)};
}
template <typename Item, typename Result>
Pipeline<Item, Result> operator&(Start<Item, Result> start, Sink<Result> sink) {
  return {std::move(start.source), std::move(start.work), std::move(sink)};
}

/// One pipeline at work: items are drawn one after the other, and taken in the same order.
template <typename Item, typename Result>
class Run {
 public:
  explicit Run(const Pipeline<Item, Result>& pipeline) : pipeline_(pipeline) {}

  /// What each thread does.
  void work() {
    try {
      while (one_item()) {
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      failed_ = true;
      turn_changed_.notify_all();
      throw;
    }
  }

 private:
  bool one_item() {
    std::unique_lock lock(mutex_);
    if (control_.stopped() || failed_) return false;
    Item item = pipeline_.source.next(control_);
    if (control_.stopped()) return false;
    const std::size_t number = drawn_++;
    lock.unlock();
    Result result = pipeline_.work.run(std::move(item));
    lock.lock();
    turn_changed_.wait(lock, [&] { return turn_ == number || failed_; });
    if (failed_) return false;
    pipeline_.sink.take(std::move(result));
    ++turn_;
    turn_changed_.notify_all();
    return true;
  }

  const Pipeline<Item, Result>& pipeline_;
  std::mutex mutex_;  ///< of what follows, and of the serial filters
  std::condition_variable turn_changed_;
  flow_control control_;
  std::size_t drawn_ = 0;
  std::size_t turn_ = 0;
  bool failed_ = false;
};

}  // namespace plain

template <typename In, typename Out, typename Function>
typename plain::FilterOf<In, Out>::Type make_filter(filter_mode, Function function) {
  return {std::move(function)};
}

template <typename Item, typename Result>
void parallel_pipeline(std::size_t, const plain::Pipeline<Item, Result>& pipeline) {
  plain::Run<Item, Result> run(pipeline);
  plain::in_threads([&] { run.work(); });
}

}  // namespace tbb
