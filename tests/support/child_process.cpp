#include "support/child_process.hpp"

#include <array>
#include <csignal>
#include <cstdlib>

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace touchtrial::testing {
namespace {

/// Only a hanging program takes this long.
constexpr std::chrono::seconds kTimeout{300};
constexpr std::chrono::seconds kPollInterval{1};

/// Runs in the child.
[[noreturn]] void exec_child(std::vector<char*>& arguments,
                             const std::vector<std::string>& environment, const std::string& folder,
                             int input, int output) {
  if (!folder.empty() && chdir(folder.c_str()) != 0) _exit(127);
  dup2(input, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  for (const std::string& entry : environment) {
    const std::size_t equals = entry.find('=');
    setenv(entry.substr(0, equals).c_str(), entry.substr(equals + 1).c_str(), 1);
  }
  execv(arguments.front(), arguments.data());
  _exit(127);
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& arguments,
                           const std::vector<std::string>& environment, const std::string& folder) {
  std::array<int, 2> to_child{};
  std::array<int, 2> from_child{};
  if (pipe2(to_child.data(), O_CLOEXEC) != 0 || pipe2(from_child.data(), O_CLOEXEC) != 0) return;
  std::vector<std::string> argument_copy = arguments;
  std::vector<char*> pointers;
  for (std::string& argument : argument_copy) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  process_ = fork();
  if (process_ == 0) exec_child(pointers, environment, folder, to_child[0], from_child[1]);
  ::close(to_child[0]);
  ::close(from_child[1]);
  input_ = to_child[1];
  output_pipe_ = from_child[0];
}

ChildProcess::~ChildProcess() {
  if (input_ >= 0) ::close(input_);
  if (output_pipe_ >= 0) ::close(output_pipe_);
  if (process_ <= 0) return;
  kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
}

void ChildProcess::close_input() {
  if (input_ >= 0) ::close(input_);
  input_ = -1;
}

void ChildProcess::send_signal(int signal) {
  if (process_ > 0) kill(process_, signal);
}

void ChildProcess::write(const std::string& text) {
  [[maybe_unused]] const ssize_t written = ::write(input_, text.data(), text.size());
}

bool ChildProcess::listen(std::chrono::milliseconds longest) {
  pollfd waiting{output_pipe_, POLLIN, 0};
  if (output_ended_ || poll(&waiting, 1, static_cast<int>(longest.count())) <= 0)
    return !output_ended_;
  std::array<char, 4096> bytes{};
  const ssize_t count = ::read(output_pipe_, bytes.data(), bytes.size());
  output_ended_ = count <= 0;
  if (!output_ended_) output_.append(bytes.data(), static_cast<std::size_t>(count));
  return !output_ended_;
}

bool ChildProcess::says(const std::string& text) {
  const auto until = std::chrono::steady_clock::now() + kTimeout;
  while (output_.find(text) == std::string::npos) {
    if (!listen(kPollInterval) || std::chrono::steady_clock::now() > until) return false;
  }
  return true;
}

int ChildProcess::finish() {
  const auto until = std::chrono::steady_clock::now() + kTimeout;
  while (listen(kPollInterval)) {
    if (std::chrono::steady_clock::now() > until) return -1;
  }
  int status = 0;
  waitpid(process_, &status, 0);
  process_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace touchtrial::testing
