"""A headless Chromium, driven through its DevTools protocol over a pipe with Python's standard library only."""
import base64
import json
import os
import subprocess
import tempfile
import time

CHROMIUM = os.environ.get("CHROMIUM", "")


class Browser:
    """One page at a time. What it says on its console, throws or asks the network for is kept."""

    def __init__(self):
        self._profile = tempfile.TemporaryDirectory(prefix="polar-browser-")
        command_out, self._out = os.pipe()
        self._in, answers_in = os.pipe()
        # The browser reads commands from 3 and writes answers to 4.
        shell = f'exec "$0" "$@" 3<&{command_out} 4>&{answers_in}'
        self._process = subprocess.Popen(
            ["bash", "-c", shell, CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--remote-debugging-pipe",
             "--hide-scrollbars", "--disable-dev-shm-usage", f"--user-data-dir={self._profile.name}"],
            pass_fds=(command_out, answers_in), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(command_out)
        os.close(answers_in)
        self._buffer, self._number, self._session = b"", 0, None
        self.said, self.requests, self._loaded = [], [], False
        target = self._call("Target.createTarget", url="about:blank")["targetId"]
        self._session = self._call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self._call(f"{domain}.enable")

    def close(self):
        try:
            self._session = None
            self._call("Browser.close")
            self._process.wait(timeout=20)
        except (OSError, EOFError, subprocess.TimeoutExpired):
            self._process.kill()
            self._process.wait()
        os.close(self._out)
        os.close(self._in)
        self._profile.cleanup()

    def open(self, path, width=1280, dark=False):
        """Loads a file as a window of that width shows it."""
        self.said, self.requests, self._loaded = [], [], False
        self._call("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=width < 600)
        self._call("Emulation.setEmulatedMedia",
                   features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        self._call("Page.navigate", url=path.resolve().as_uri())
        self._until(lambda: self._loaded)

    def value(self, script):
        """What the expression is, as JSON can say it."""
        answer = self._call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise AssertionError(answer["exceptionDetails"])
        return answer["result"].get("value")

    def screenshot(self, path, whole=True):
        size = self._call("Page.getLayoutMetrics")["cssContentSize"]
        picture = self._call("Page.captureScreenshot", captureBeyondViewport=whole,
                             clip={"x": 0, "y": 0, "width": size["width"], "height": min(size["height"], 15000), "scale": 1})
        path.write_bytes(base64.b64decode(picture["data"]))

    def key(self, name):
        for kind in ("keyDown", "keyUp"):
            self._call("Input.dispatchKeyEvent", type=kind, key=name, code=name)

    def _call(self, method, **parameters):
        self._number += 1
        number = self._number
        message = {"id": number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._out, json.dumps(message).encode() + b"\0")
        answers = []
        self._until(lambda: answers, lambda m: answers.append(m) if m.get("id") == number else None)
        if "error" in answers[0]:
            raise AssertionError(f"{method}: {answers[0]['error']}")
        return answers[0]["result"]

    def _until(self, done, look=lambda message: None):
        deadline = time.monotonic() + 120
        while not done():
            if time.monotonic() > deadline:
                raise TimeoutError("the browser does not answer")
            message = self._read()
            look(message)
            self._note(message)

    def _read(self):
        while b"\0" not in self._buffer:
            part = os.read(self._in, 1 << 20)
            if not part:
                raise EOFError("the browser ended")
            self._buffer += part
        message, self._buffer = self._buffer.split(b"\0", 1)
        return json.loads(message)

    def _note(self, message):
        method, details = message.get("method"), message.get("params", {})
        if method == "Page.loadEventFired":
            self._loaded = True
        elif method == "Runtime.consoleAPICalled":
            self.said.append(" ".join(str(a.get("value", a.get("description"))) for a in details["args"]))
        elif method == "Runtime.exceptionThrown":
            self.said.append(json.dumps(details["exceptionDetails"]))
        elif method == "Log.entryAdded":
            self.said.append(details["entry"]["text"])
        elif method == "Network.requestWillBeSent":
            self.requests.append(details["request"]["url"])
