# The project with everything that it needs, for Docker, Podman or Buildah:
#     docker build -t mobnet .
#     docker run -it --init -v mobnet:/mobnet mobnet demo    # or all, test, --help ...; the volume keeps what was made
# On a cluster, apptainer.def has the same system packages and leaves the project in its folder.
FROM debian:12
# TeX and its pages; pictures; clips. Without them the paper stays a .tex file, and pictures and clips are left out.
ARG EXTRAS="texlive-latex-recommended texlive-publishers texlive-fonts-recommended latexmk poppler-utils \
            libegl1 libegl-mesa0 libgl1-mesa-dri ffmpeg"
RUN apt-get update \
 && apt-get install -y --no-install-recommends ca-certificates git python3-venv $EXTRAS \
 && rm -rf /var/lib/apt/lists/*
WORKDIR /mobnet
COPY . .
# Takes the CPU build of torch where an index offers it, 3.4 GB less.
RUN ./reproduce setup
ENTRYPOINT ["./reproduce"]
CMD ["--help"]
