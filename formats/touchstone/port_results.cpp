// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/touchstone/port_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>

#include "formats/syntax/input_file.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::touchstone {
namespace {

constexpr std::string_view mark = "# pcbmesh port results 1";
constexpr std::size_t most_ports = 999;

/// One line of the file and the words on it.
class Line {
 public:
  Line(std::string_view text, std::int64_t number, const std::string& file) : rest_(text), number_(number), file_(file) {}
  [[noreturn]] void fail(std::string_view expected, ErrorCode code = ErrorCode::file_syntax) const {
    throw Error(code, fmt::format("expected {}; the file is damaged or no port results of a deck of pcbmesh", expected),
                {.file = file_, .line = number_});
  }
  std::string_view word() {
    skip_blanks();
    const std::size_t end = std::min(rest_.find_first_of(" \t\r"), rest_.size());
    const std::string_view out = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return out;
  }
  double number(std::string_view what) {
    const std::string_view text = word();
    double value = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (fault != std::errc() || end != text.data() + text.size()) fail(what);
    if (!std::isfinite(value)) fail(fmt::format("a finite {}", what), ErrorCode::input_number);
    return value;
  }
  std::size_t port(std::size_t most) {
    const double value = number("the number of a port");
    if (!(value >= 1 && value <= static_cast<double>(most)) || value != std::floor(value))
      fail(fmt::format("a port number in 1..{}", most));
    return static_cast<std::size_t>(value) - 1;
  }
  std::string_view rest() {
    skip_blanks();
    std::string_view out = rest_;
    while (out.ends_with('\r') || out.ends_with(' ')) out.remove_suffix(1);
    return out;
  }

 private:
  void skip_blanks() {
    while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\t' || rest_.front() == '\r')) rest_.remove_prefix(1);
  }
  std::string_view rest_;
  std::int64_t number_;
  const std::string& file_;
};

}  // namespace

ScatteringSweep read_port_results(const std::filesystem::path& file) {
  const std::string text = syntax::read_whole_file(file), name = file.string();
  if (!text.starts_with(mark)) Line("", 1, name).fail(fmt::format("'{}'", mark));
  constexpr double unset = std::numeric_limits<double>::quiet_NaN();
  ScatteringSweep sweep;
  std::map<double, std::vector<Complex>> rows;
  std::int64_t number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    Line line(std::string_view(text).substr(at, end - at), ++number, name);
    at = end + 1;
    std::string_view first = Line(line).word();
    if (first.empty()) continue;
    if (first == "#") {
      (void)line.word();
      if (line.word() != "port" || number == 1) continue;
      if (line.port(most_ports) != sweep.ports.size() || !rows.empty()) line.fail("the ports in order, before all values");
      const double ohm = line.number("the impedance of the port");
      if (!(ohm > 0)) line.fail("an impedance above 0");
      sweep.ports.push_back({std::string(line.rest()), ohm});
      continue;
    }
    const std::size_t n = sweep.ports.size();
    const double hz = line.number("a frequency");
    if (!(hz > 0)) line.fail("a frequency above 0");
    const std::size_t excited = line.port(n), observed = line.port(n);
    const double re = line.number("a real part"), im = line.number("an imaginary part");
    auto& s = rows.try_emplace(hz, n * n, Complex(unset, unset)).first->second;
    // A wave of 1 V enters a port of its own impedance; power waves need the roots.
    s[observed * n + excited] =
        Complex(re, im) * std::sqrt(sweep.ports[excited].impedance_ohm / sweep.ports[observed].impedance_ohm);
  }
  if (rows.empty())
    throw Error(ErrorCode::file_truncated, "no values: the solver stopped before its first frequency; look at what it printed",
                {.file = name});
  const std::size_t n = sweep.ports.size();
  for (auto& [hz, s] : rows) {
    for (std::size_t k = 0; k < s.size(); ++k)
      if (std::isnan(s[k].real()))
        throw Error(ErrorCode::file_truncated,
                    fmt::format("S({},{}) is missing at {} Hz: the run was stopped, or port '{}' is not excited; Touchstone "
                                "needs the full matrix",
                                k / n + 1, k % n + 1, hz, sweep.ports[k % n].name),
                    {.file = name});
    sweep.frequencies_hz.push_back(hz);
    sweep.scatter.push_back(std::move(s));
  }
  return sweep;
}

}  // namespace pcbmesh::formats::touchstone
