/// \file A child process that a test drives through pipes.
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
  /// \param environment  "NAME=VALUE", added to this process's environment
  /// \param folder  its working directory; empty: that of this process
  ChildProcess(const std::vector<std::string>& arguments,
               const std::vector<std::string>& environment, const std::string& folder = "");
  ~ChildProcess();  ///< kills it if it still runs
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  void write(const std::string& text);
  /// Closes the program's standard input.
  void close_input();
  void send_signal(int signal);
  /// Reads output, waiting at most `longest` for it.
  /// \return false at the end of the output
  [[nodiscard]] bool listen(std::chrono::milliseconds longest);
  /// Waits until the output of both streams contains the text.
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
  bool output_ended_ = false;
};

}  // namespace touchtrial::testing
