"""Run times of the Python module, the C++ call, PyWavelets and scikit-image, as medians of interleaved rounds. Called
by scripts/bench-python."""

import statistics
import sys
import time

import numpy as np
import pywt
import touchtrial
from skimage.feature import graycomatrix, graycoprops
from skimage.metrics import structural_similarity
from touchtrial import _touchtrial

SIDES = (256, 512, 1024)


def picture(side):
    random = np.random.default_rng(1)
    y, x = np.mgrid[:side, :side]
    waves = 128 + 60 * np.sin(x / 4.0) * np.cos(y / 5.0) + random.normal(0, 8, (side, side))
    return np.clip(waves, 0, 255).astype(np.uint8)


def co_occurrences(image):
    matrix = graycomatrix(image, [1], [0, np.pi / 4, np.pi / 2, 3 * np.pi / 4], 256, normed=True)
    return [graycoprops(matrix, name) for name in ("ASM", "energy", "contrast", "correlation")]


def measure_s(call):
    start = time.perf_counter()
    call()
    return time.perf_counter() - start


def cases(side):
    image = picture(side)
    texture = touchtrial.extract(image).texture_u8
    pixels = np.ascontiguousarray(image.astype(float))
    return {
        "texture, C++": lambda: _touchtrial._seconds_of_extraction(image, False),
        "texture": lambda: measure_s(lambda: touchtrial.extract(image, planes=())),
        "all planes, C++": lambda: _touchtrial._seconds_of_extraction(image, True),
        "all planes": lambda: measure_s(lambda: touchtrial.extract(image)),
        "pywt": lambda: measure_s(lambda: pywt.dwt2(pixels, "db2", mode="symmetric")),
        "evaluate": lambda: measure_s(lambda: touchtrial.evaluate(image)),
        "glcm": lambda: measure_s(lambda: (co_occurrences(image), co_occurrences(texture))),
        "sweep": lambda: measure_s(lambda: touchtrial.evaluate(image, sweep=True)),
        "ssim": lambda: measure_s(lambda: structural_similarity(image, texture)),
    }


def main():
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 15
    rows = []
    for side in SIDES:
        calls = cases(side)
        seconds = {name: [] for name in calls}
        for _ in range(rounds):
            for name, call in calls.items():
                call()  # warms memory and caches for this call
                seconds[name].append(call())
        ms = {name: 1000 * statistics.median(times) for name, times in seconds.items()}
        rows += [
            (side, "`extract(planes=())`", ms["texture"], "the C++ call", ms["texture, C++"]),
            (side, "`extract()`", ms["all planes"], "the C++ call", ms["all planes, C++"]),
            (side, "`extract()`", ms["all planes"], "PyWavelets, `dwt2` only", ms["pywt"]),
            (side, "`evaluate()`", ms["evaluate"], "scikit-image, both GLCMs only", ms["glcm"]),
            (side, "`evaluate(sweep=True)`", ms["sweep"], "scikit-image, 19 SSIMs only", 19 * ms["ssim"]),
        ]
    print("| picture | ours | ms | peer | ms | ours / peer |")
    print("| --- | --- | --- | --- | --- | --- |")
    for side, ours, our_ms, peer, peer_ms in rows:
        print(
            f"| {side} x {side} | {ours} | {our_ms:.3g} | {peer} | {peer_ms:.3g} | "
            f"{our_ms / peer_ms:.2f} |"
        )


if __name__ == "__main__":
    main()
