#include "world/app/run_city.h"

namespace cuscus::world {

RunCity::RunCity(const city::City& city) : geometry{city}, origin{city.origin} {}

}  // namespace cuscus::world
