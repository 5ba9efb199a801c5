/// \file One run of gnuplot. Private to figures.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace touchtrial::analysis {

/// Starts when it is made; several may run at the same time.
class GnuplotProcess {
 public:
  /// \param argument  of the command line, may be empty \param script  its standard input
  /// \throws Error if gnuplot cannot be started \throws FileError without temporary files
  GnuplotProcess(std::string argument, std::string_view script);
  /// Waits for its end.
  ~GnuplotProcess();
  GnuplotProcess(GnuplotProcess&&) noexcept;
  GnuplotProcess& operator=(GnuplotProcess&&) = delete;

  /// Waits for its end. \return what it printed
  /// \throws Error if gnuplot failed
  [[nodiscard]] std::string result();

 private:
  struct Run;
  std::unique_ptr<Run> run_;
};

}  // namespace touchtrial::analysis
