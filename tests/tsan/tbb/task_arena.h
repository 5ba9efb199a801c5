/// \file tbb::task_arena without an arena. See ../README.md.
#pragma once

namespace tbb {

class task_arena {
 public:
  explicit task_arena(int) {}

  template <typename Work>
  void execute(const Work& work) {
    work();
  }
};

}  // namespace tbb
