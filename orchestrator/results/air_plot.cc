#include "orchestrator/results/air_plot.h"

#include <spdlog/fmt/fmt.h>

namespace cuscus::orchestrator {
namespace {

/// As a gnuplot string, in which only the quote is special.
std::string quoted(const std::string& text) {
  std::string result{'\''};
  for (const char c : text) {
    result += c;
    if (c == '\'') {
      result += c;
    }
  }
  return result + '\'';
}

}  // namespace

AirPlotFiles AirPlotFiles::beside(const std::filesystem::path& table) {
  const auto with = [&table](const char* extension) {
    return std::filesystem::path{table}.replace_extension(extension);
  };
  return {.table = table, .script = with(".gp"), .svg = with(".svg"), .png = with(".png")};
}

std::string air_plot_script(const AirPlotFiles& files, const std::string& title, bool over_nodes) {
  const std::string x = over_nodes ? "nodes" : "seed";
  return fmt::format(
      R"(table = {table}
set datafile separator ','
set grid linetype 1 linecolor '#d8d8d8'
set key noenhanced above
set lmargin 10
set xlabel '{x}'
set offsets graph 0.03, graph 0.03, 0, 0
points(column_name) = sprintf("table using (column('{x}')):(column('%s')) notitle " . \
    "with points pointtype 6 pointsize 0.5 linecolor '#888888'", column_name)
means(column_name, name) = sprintf("table using (column('{x}')):(column('%s')) smooth unique " . \
    "title '%s' with linespoints pointtype 7 pointsize 0.5 linewidth 2", column_name, name)
curve(column_name, name) = points(column_name) . ", " . means(column_name, name)
do for [i = 1:2] {{
  if (i == 1) {{ set terminal svg size 640,900 noenhanced; set output {svg} }}
  if (i == 2) {{ set terminal pngcairo size 640,900 noenhanced; set output {png} }}
  set multiplot layout 3,1 title {title}
  set yrange [0:*]
  set ylabel 'goodput [Mb/s]'
  eval "plot " . curve('goodput_mbps', 'goodput')
  set yrange [0:1.02]
  set ylabel 'delivery ratio'
  eval "plot " . curve('delivery_ratio', 'delivery')
  set yrange [0:*]
  set ylabel 'delay [us]'
  eval "plot " . curve('delay_mean_us', 'mean') . ", " . means('delay_p99_us', '99 %')
  unset multiplot
  unset output
}}
)",
      fmt::arg("table", quoted(files.table.filename().string())), fmt::arg("x", x),
      fmt::arg("svg", quoted(files.svg.filename().string())),
      fmt::arg("png", quoted(files.png.filename().string())), fmt::arg("title", quoted(title)));
}

}  // namespace cuscus::orchestrator
