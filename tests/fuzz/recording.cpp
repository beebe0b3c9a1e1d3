// SPDX-License-Identifier: BSD-3-Clause
// Reads arbitrary bytes as a recording; a recording that opens can be replayed and written as tables.
#include "vps_device/recording.h"

#include "fuzz.h"
#include "vps/errors.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    vps::device::Recording device(
        vps::device::recordingFrom({reinterpret_cast<const char*>(data), size}, "fuzz"));
    const std::size_t reads = device.run().reads();
    for (std::size_t i = 0; i < reads; ++i) {
      device.read();
      (void)device.phase();
    }
    vps::fuzz::require(device.left() == 0, "every sample is read once");
    vps::fuzz::require(device.read().status == vps::Status::Fault, "then the device is lost");
    vps::fuzz::require(vps::device::csvTables(device.run()).size() == 5, "a table for each kind");
  } catch (const vps::LoadError&) {
  }
  return 0;
}

std::vector<std::string> vps::fuzz::seeds() {
  const std::string file = fileOf(nullptr, 0);
  device::RecordingHead head;
  head.about = {{"version", "1"}};
  head.device = "fuzz";
  head.attachments = {{"scene", "text/plain", "scene"}};
  {
    device::Recorder recorder(file, head);
    device::RunEvent event;
    event.kind = device::RunEventKind::Phase;
    event.setWords("phase");
    recorder.add(event);
    for (int i = 0; i < 3; ++i) {
      device::DeviceSample sample;
      sample.time_s = i;
      recorder.add(sample);
      recorder.add(device::WrittenWrench{});
    }
    recorder.add(device::RunTrace{});
    recorder.finish();
  }
  return {bytesOf(file)};
}
