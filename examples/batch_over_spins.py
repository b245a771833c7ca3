"""Pictures over a range of spins by several processes, each with a renderer of its own. Writes spin_0.00.png and so on."""

from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import blackhole_gl as bh


def draw(spin: float) -> str:
    return str(bh.save(f"spin_{spin:.2f}.png", bh.load("kerr", {"hole.spin": spin}), (160, 90)))


if __name__ == "__main__":
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        for name in pool.map(draw, (0.0, 0.3, 0.6, 0.9)):
            print(name)
