#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <string_view>

#include "netsim/app/synthetic.h"
#include "proto/synthetic.pb.h"

namespace cuscus::netsim {

/// The columns that result_fields() fills, separated by commas.
[[nodiscard]] std::string_view result_columns();

/// What a run has measured, as fields of a CSV line; losses and drops are of all nodes and of the
/// whole run, warm-up included.
[[nodiscard]] std::string result_fields(const SyntheticResult& result);

/// Simulates one run after the other and writes a CSV table, each line as soon as its run is over.
/// `output` is asked for once, when the first run is over.
/// @throws std::invalid_argument when a run cannot be simulated, std::runtime_error when a line
///   cannot be written.
void print_runs(const proto::SyntheticRuns& runs, const std::function<std::ostream&()>& output);

}  // namespace cuscus::netsim
