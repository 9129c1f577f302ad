# The desk for an intranet, with the specs of the present folder, at an address of this machine (Linux):
#   docker build -t conveyor .
#   docker run --rm -it --network host -v "$PWD:/specs" -e ADDRESS=192.168.1.20 -e CONVEYOR_DESK_PASSWORD conveyor
# Nothing is encrypted: where others can listen, put a proxy with https or a tunnel before it (docs/desk.md).
FROM python:3.12-slim
COPY . /source
RUN pip install --no-cache-dir "/source[desk]" && rm -rf /source && useradd --create-home designer
USER designer
WORKDIR /specs
CMD ["sh", "-c", "exec conveyor desk --no-browser --host \"$ADDRESS\""]
