/// \file A program that runs beside the test, spoken to through pipes.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include <sys/types.h>

namespace touchtrial::testing {

class ChildProcess {
 public:
  /// Starts it. \param arguments  the program's path first
  /// \param environment  "NAME=VALUE", on top of this process's
  /// \param folder  where it works; empty: here
  ChildProcess(const std::vector<std::string>& arguments,
               const std::vector<std::string>& environment, const std::string& folder = "");
  ~ChildProcess();  ///< ends it if it still runs
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  void write(const std::string& text);
  /// Its input ends.
  void close_input();
  void send_signal(int signal);
  /// Reads what it says within this time, or before. \return false at the end of its output
  [[nodiscard]] bool listen(std::chrono::milliseconds longest);
  /// Reads until its output, both streams together, holds this. \return false if it ended first, or
  ///   hangs
  [[nodiscard]] bool says(const std::string& text);
  /// Reads to its end. \return its exit code; -1 if it died by a signal, or hangs
  [[nodiscard]] int finish();
  [[nodiscard]] const std::string& output() const { return output_; }

 private:
  pid_t process_ = -1;
  int input_ = -1;
  int output_pipe_ = -1;
  std::string output_;
  bool ended_ = false;  ///< the output
};

}  // namespace touchtrial::testing
