#include "world/sensors/imu.h"

#include "world/sensors/white_noise.h"

namespace cuscus::world {

Imu::Imu(std::uint64_t seed, std::uint32_t node, const ImuNoise& noise)
    : gyro_{seed, random::stream_id(NoisePurpose::kGyro, node)},
      accelerometer_{seed, random::stream_id(NoisePurpose::kAccelerometer, node)},
      noise_{noise} {}

ImuSample Imu::sample(const ImuSample& truth, std::uint64_t reading) const {
  return {
      .angular_rate_B_radps =
          truth.angular_rate_B_radps + noise_.gyro_radps * normal_vector(gyro_, reading),
      .specific_force_B_mps2 = truth.specific_force_B_mps2 +
                               noise_.accelerometer_mps2 * normal_vector(accelerometer_, reading)};
}

}  // namespace cuscus::world
