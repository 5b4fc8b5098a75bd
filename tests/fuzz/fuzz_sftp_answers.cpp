// What an sftp server answers when an archive is read from it: in place of ssh a program prints the input.
#include "tests/codec/fake_ssh.h"
#include "tests/fuzz/fuzz_remote.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const tessera::test::FakeSsh ssh;
    ssh.answer(std::as_bytes(std::span(data, size)));
    tessera::fuzz::readRemote("sftp://fuzz/run.tsr", ssh.folder);
    return 0;
}
