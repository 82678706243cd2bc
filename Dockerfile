# An image that runs studies: a wheel made in the first stage, and only what it needs in the second.
#   docker build -t codesign .
#   docker run --rm -v "$PWD:/work" codesign optimize --study my_study --out runs/first
FROM debian:12 AS build
RUN apt-get update && apt-get install -y --no-install-recommends ca-certificates git make python3 python3-venv
COPY . /source
WORKDIR /source
RUN make wheel

FROM debian:12-slim
RUN apt-get update && apt-get install -y --no-install-recommends libgl1 python3-venv && rm -rf /var/lib/apt/lists/*
COPY --from=build /source/dist/ /wheels/
RUN python3 -m venv /opt/codesign && /opt/codesign/bin/pip install --no-cache-dir /wheels/*.whl && rm -r /wheels
ENV PATH=/opt/codesign/bin:$PATH
WORKDIR /work
ENTRYPOINT ["codesign"]
