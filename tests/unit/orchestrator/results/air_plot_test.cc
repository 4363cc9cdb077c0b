#include "orchestrator/results/air_plot.h"

#include <catch2/catch.hpp>

namespace cuscus::orchestrator {
namespace {

TEST_CASE("the files of a drawing lie beside their table, with its name") {
  const AirPlotFiles files = AirPlotFiles::beside("/results/of it/curve.v2.csv");
  CHECK(files.script == "/results/of it/curve.v2.gp");
  CHECK(files.svg == "/results/of it/curve.v2.svg");
  CHECK(files.png == "/results/of it/curve.v2.png");
}

TEST_CASE("a drawing's script names its files without their folder, whatever their names") {
  const std::string script =
      air_plot_script(AirPlotFiles::beside("/elsewhere/it's.csv"), "a 'title'", true);
  CHECK_THAT(script, Catch::Contains("table = 'it''s.csv'\n"));
  CHECK_THAT(script, Catch::Contains("set output 'it''s.svg'"));
  CHECK_THAT(script, Catch::Contains("title 'a ''title'''"));
  CHECK_THAT(script, !Catch::Contains("/elsewhere"));
  CHECK_THAT(script, Catch::Contains("set xlabel 'nodes'"));
}

}  // namespace
}  // namespace cuscus::orchestrator
