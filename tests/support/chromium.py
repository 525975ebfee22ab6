"""A Chromium without a screen, spoken to through a pipe by its DevTools protocol."""

import json
import os
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

PROGRAM = next((name for name in ("chromium", "google-chrome") if shutil.which(name)), None)
FLAGS = (
    *("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
    *("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"),
    *("--remote-debugging-pipe", "--hide-scrollbars", "--force-device-scale-factor=1"),
)


class Page:
    """One tab."""

    def __init__(self, to: int, back: int) -> None:
        self._to, self._back = to, back
        self._rest = b""
        self._count = 0
        self._session: str | None = None
        self._session = self._attach()

    def _attach(self) -> str:
        target = self.say("Target.createTarget", url="about:blank")["targetId"]
        session: str = self.say("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        return session

    def say(self, method: str, **parameters: object) -> Any:
        """Give a command of the protocol, and return what it answers."""
        self._count += 1
        message: dict[str, object] = {"id": self._count, "method": method, "params": parameters}
        if self._session is not None:
            message["sessionId"] = self._session
        os.write(self._to, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._read()
            if answer.get("id") == self._count:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]

    def open(self, path: Path, size: tuple[int, int]) -> None:
        """Show a file in a frame of this size."""
        self.say(
            "Emulation.setDeviceMetricsOverride",
            width=size[0],
            height=size[1],
            deviceScaleFactor=1,
            mobile=False,
        )
        self.say("Page.navigate", url=path.as_uri())
        self.run("new Promise(r => document.readyState == 'complete' ? r() : onload = r)")

    def run(self, script: str) -> Any:
        """Run a script, wait for its promise, and return its value."""
        answer = self.say(
            "Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True
        )
        if "exceptionDetails" in answer:
            raise RuntimeError(str(answer["exceptionDetails"]))
        return answer["result"].get("value")

    def _read(self) -> dict[str, Any]:
        while b"\0" not in self._rest:
            part = os.read(self._back, 1 << 20)
            if not part:
                raise RuntimeError("Chromium has ended")
            self._rest += part
        message, _, self._rest = self._rest.partition(b"\0")
        content: dict[str, Any] = json.loads(message)
        return content


@contextmanager
def chromium(folder: Path) -> Iterator[Page]:
    """Lend a tab of a Chromium that keeps what it knows in a folder."""
    assert PROGRAM is not None
    commands, answers = os.pipe(), os.pipe()

    def wire() -> None:
        # Where the protocol has its ends: it reads from 3 and writes to 4.
        os.dup2(commands[0], 13)
        os.dup2(answers[1], 14)
        os.dup2(13, 3)
        os.dup2(14, 4)

    process = subprocess.Popen(
        [PROGRAM, *FLAGS, f"--user-data-dir={folder}"],
        preexec_fn=wire,  # noqa: PLW1509 - between fork and exec nothing but these two ends is set
        close_fds=False,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    os.close(commands[0])
    os.close(answers[1])
    try:
        yield Page(commands[1], answers[0])
    finally:
        os.close(commands[1])
        process.terminate()
        process.wait()
        os.close(answers[0])
