/// \file Running gnuplot, which must be installed only if a figure is wanted.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace touchtrial::analysis {

/// One run of gnuplot. It starts on construction; several may run at the same time. gnuplot starts
/// from its defaults, whatever the user's own settings are.
class GnuplotProcess {
 public:
  /// \param argument  of the command line; may be empty
  /// \param script  its standard input
  /// \throws Error if gnuplot cannot be started
  /// \throws FileError if temporary files cannot be made
  GnuplotProcess(std::string argument, std::string_view script);
  /// Waits until it exits.
  ~GnuplotProcess();
  GnuplotProcess(GnuplotProcess&&) noexcept;
  GnuplotProcess& operator=(GnuplotProcess&&) = delete;

  /// Waits until it exits.
  /// \return what it printed
  /// \throws Error if gnuplot failed
  [[nodiscard]] std::string result();

 private:
  struct Run;
  std::unique_ptr<Run> run_;
  bool asks_version_;
};

/// Call before a long computation that ends in a figure.
/// \throws Error, with the remedy, if gnuplot is not installed or does not start
void require_gnuplot();

/// The end of a message that gnuplot drew no picture or not the wanted one: what may help, by the
/// version that it says it has. Begins with "; ".
/// \throws Error as require_gnuplot
[[nodiscard]] std::string gnuplot_remedy();

/// A text as a gnuplot string: on one line, in quotes. Whether gnuplot interprets mark-up is up to
/// the script ("noenhanced").
[[nodiscard]] std::string gnuplot_string(const std::string& text);

}  // namespace touchtrial::analysis
