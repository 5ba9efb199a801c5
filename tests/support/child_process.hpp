/// \file A program that runs beside the test, which talks to it through pipes.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include <sys/types.h>

namespace touchtrial::testing {

class ChildProcess {
 public:
  /// Starts the process.
  /// \param arguments  the program's path first
  /// \param environment  "NAME=VALUE", in addition to this process's
  /// \param folder  its working directory; empty: that of this process
  ChildProcess(const std::vector<std::string>& arguments,
               const std::vector<std::string>& environment, const std::string& folder = "");
  ~ChildProcess();  ///< ends it if it still runs
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  void write(const std::string& text);
  /// Ends the program's input.
  void close_input();
  void send_signal(int signal);
  /// Waits for output, at most this long, and reads it.
  /// \return false at the end of the output
  [[nodiscard]] bool listen(std::chrono::milliseconds longest);
  /// Reads until the output, both streams together, contains this text.
  /// \return false if the output ended first, or the process hangs
  [[nodiscard]] bool says(const std::string& text);
  /// Reads the rest of the output.
  /// \return the exit code; -1 if a signal killed the process, or it hangs
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
