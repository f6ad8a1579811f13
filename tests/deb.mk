# `make deb`: included by the Makefile.

# A Debian package of what install puts under /usr, in build/. The libraries that it depends on, and from which version on, are those that
# dpkg-shlibdeps finds in the programs. WordNet's words are files that no program links.
DEB := $(BUILD)/deb
DEB_ARCH = $(shell dpkg --print-architecture)
DEB_FILE = $(BUILD)/refersplat_$(VERSION)_$(DEB_ARCH).deb
MAINTAINER ?= refersplat <refersplat@localhost>

deb: all ## make a Debian package, build/refersplat_VERSION_ARCH.deb
	$(call need,dpkg-deb=dpkg dpkg-shlibdeps=dpkg-dev strip=binutils)
	@rm -rf $(DEB)
	@$(MAKE) --no-print-directory -s install DESTDIR="$(abspath $(DEB))/root" PREFIX=/usr LIBDIR=/usr/lib/$$(dpkg-architecture -qDEB_HOST_MULTIARCH)
	@strip --strip-unneeded $(TOOLS:%=$(DEB)/root/usr/bin/%) $(DEB)/root/usr/lib/*/$(notdir $(SHARED))
	@strip --strip-debug $(DEB)/root/usr/lib/*/$(notdir $(STATIC))
	@gzip -9n $(DEB)/root/usr/share/man/man*/*
	@mkdir $(DEB)/debian $(DEB)/root/DEBIAN
	@printf 'Source: refersplat\n\nPackage: refersplat\nArchitecture: any\n' >$(DEB)/debian/control
	@cd $(DEB) && dpkg-shlibdeps -O $(TOOLS:%=-eroot/usr/bin/%) -e"$$(echo root/usr/lib/*/$(notdir $(SHARED)))" >depends 2>shlibdeps.log || \
		{ cat shlibdeps.log >&2; exit 1; }
	@cd $(DEB)/root && find usr -type f | LC_ALL=C sort | xargs -d '\n' md5sum >DEBIAN/md5sums
	@printf '%s\n' 'Package: refersplat' 'Version: $(VERSION)' 'Architecture: $(DEB_ARCH)' 'Maintainer: $(MAINTAINER)' 'Section: graphics' \
		'Priority: optional' "Installed-Size: $$(du -k -s $(DEB)/root/usr | cut -f 1)" \
		"Depends: $$(sed -n 's/^shlibs:Depends=//p' $(DEB)/depends)$(if $(filter -lwordnet,$(LDLIBS)),$(comma) wordnet-base)" \
		'Recommends: make, jq, npm' 'Suggests: libcjson-dev, pkg-config' \
		'Description: find what a sentence means in a 3D Gaussian Splatting scene' \
		' Given a trained scene, posed photographs and sentences, these programs find the' \
		' Gaussians of the object that each sentence means, draw its mask for any camera,' \
		' and say where it is in space. They run on the processor alone.' >$(DEB)/root/DEBIAN/control
	@SOURCE_DATE_EPOCH=$${SOURCE_DATE_EPOCH:-$$(git log -1 --format=%ct 2>/dev/null || date +%s)} dpkg-deb $(DEB_FLAGS) --root-owner-group -b $(DEB)/root $(DEB_FILE)
