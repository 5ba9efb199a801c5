/// \file Runs gnuplot, which is needed only for figures.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace touchtrial::analysis {

/// One run of gnuplot. It starts on construction; several may run at the same time. User settings
/// of gnuplot are ignored.
class GnuplotProcess {
 public:
  /// \param argument  on the command line; may be empty
  /// \param script  its standard input
  /// \throws Error if gnuplot cannot be started
  /// \throws FileError if temporary files cannot be made
  GnuplotProcess(std::string argument, std::string_view script);
  /// Waits until gnuplot exits.
  ~GnuplotProcess();
  GnuplotProcess(GnuplotProcess&&) noexcept;
  GnuplotProcess& operator=(GnuplotProcess&&) = delete;

  /// Waits until gnuplot exits.
  /// \return its output
  /// \throws Error if gnuplot failed
  [[nodiscard]] std::string result();

 private:
  struct Run;
  std::unique_ptr<Run> run_;
  bool is_version_query_;
};

/// Call before a long computation that ends in a figure.
/// \throws Error, with the remedy, if gnuplot is not installed or does not start
void require_gnuplot();

/// The remedy at the end of a message that drawing failed; depends on gnuplot's version and begins
/// with "; ".
/// \throws Error as require_gnuplot
[[nodiscard]] std::string gnuplot_remedy();

/// A text as a gnuplot string: on one line, in quotes. Scripts disable mark-up by "noenhanced".
[[nodiscard]] std::string gnuplot_string(const std::string& text);

}  // namespace touchtrial::analysis
