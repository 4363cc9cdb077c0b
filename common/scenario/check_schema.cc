#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "common/scenario/section_readers.h"

namespace cuscus::scenario {
namespace {

using nlohmann::json;

/// valijson's context, {"<root>", "[fleet]", "[0]"}, as a JSON pointer.
std::string pointer_of(const std::vector<std::string>& context) {
  std::string pointer;
  for (const std::string& part : context) {
    if (part.size() > 2 && part.front() == '[' && part.back() == ']') {
      pointer += '/' + part.substr(1, part.size() - 2);
    }
  }
  return pointer;
}

}  // namespace

void check_against_schema(const json& document, Problems& problems) {
  const json schema_document = json::parse(scenario_schema());
  valijson::Schema schema;
  valijson::SchemaParser parser{valijson::SchemaParser::kDraft7};
  parser.populateSchema(valijson::adapters::NlohmannJsonAdapter{schema_document}, schema);

  valijson::Validator validator{valijson::Validator::kStrongTypes};
  valijson::ValidationResults results;
  const valijson::adapters::NlohmannJsonAdapter target{document};
  if (validator.validate(schema, target, &results)) {
    return;
  }
  for (valijson::ValidationResults::Error error; results.popError(error);) {
    problems.add(pointer_of(error.context), "does not follow the schema: " + error.description);
  }
}

}  // namespace cuscus::scenario
